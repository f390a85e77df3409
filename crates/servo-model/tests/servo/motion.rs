//! How the shaft moves. Units of the memory table: steps, steps/s, 100 steps/s².

use robot_servo_model::{Load, Servo, Version};

use crate::host::Host;

const MODE: u8 = 33;
const TORQUE: u8 = 40;
const GOAL: u8 = 42;
const PWM: u8 = 44;
const SPEED: u8 = 46;
const MOVING: u8 = 66;

fn moving() -> Host {
    let mut host = Host::with_one();
    host.write(1, TORQUE, &[1]);
    host
}

/// A goal with acceleration and speed, as the manufacturer's SDK writes it.
fn go(host: &mut Host, acceleration: u8, goal: u16, speed: u16) {
    let [goal_low, goal_high] = goal.to_le_bytes();
    let [low, high] = speed.to_le_bytes();
    host.write(1, 41, &[acceleration, goal_low, goal_high, 0, 0, low, high]);
}

// 1,000 steps at 1,000 steps/s and 5,000 steps/s²: 1.2 s. Halfway it is halfway.
#[test]
fn a_motion_is_a_trapezoid_of_speed() {
    let mut host = moving();
    go(&mut host, 50, 1048, 1000);
    host.wait_s(0.6);
    let halfway = host.view();
    assert!((halfway.position_steps - 1548).abs() < 25, "{halfway:?}");
    assert!((halfway.speed_steps_s + 1000.0).abs() < 30.0, "{halfway:?}");
    assert_eq!(host.read_u8(1, MOVING), 1);
    host.wait_s(0.75);
    assert!(
        (host.view().position_steps - 1048).abs() <= 3,
        "{:?}",
        host.view()
    );
    host.wait_s(0.3);
    assert_eq!(host.read_u8(1, MOVING), 0);
}

// 1,000 steps/s² for half a second: 500 steps/s, 125 steps.
#[test]
fn the_acceleration_has_the_unit_of_the_memory_table() {
    let mut host = moving();
    go(&mut host, 10, 4000, 0);
    host.wait_s(0.5);
    let view = host.view();
    assert!((view.speed_steps_s - 500.0).abs() < 15.0, "{view:?}");
    assert!((view.position_steps - 2048 - 125).abs() < 10, "{view:?}");
}

// Rated speed: 45 turns a minute. Users measured 46.
#[test]
fn without_a_speed_it_goes_as_fast_as_it_can() {
    let mut host = Host::new(vec![Servo::new(Version::Volts12, 0.0)]);
    host.write(1, TORQUE, &[1]);
    host.write_u16(1, GOAL, 4000);
    host.wait_s(0.5);
    let turns_a_minute = host.view().speed_steps_s / 4096.0 * 60.0;
    assert!((44.0..46.5).contains(&turns_a_minute), "{turns_a_minute}");
    host.wait_s(2.0);
    assert!(
        (host.view().position_steps - 4000).abs() <= 3,
        "{:?}",
        host.view()
    );
}

// Users measured 20 to 30 steps with 1.5 kg on 10 cm at 45 degrees, at the gains as shipped.
#[test]
fn a_load_pulls_the_shaft_off_its_goal() {
    let mut host = moving();
    let load = Load {
        torque_nm: 1.5 * 9.81 * 0.1 * 0.5_f64.sqrt(),
        ..Load::default()
    };
    host.wire
        .bus()
        .servo_mut(0)
        .expect("it is there")
        .set_load(load);
    host.wait_s(1.0);
    let off = host.view().position_steps - 2048;
    assert!((20..=30).contains(&off), "{off}");
    // The load register is the output in 0.1 %, and its sign bit 10: this one works against growing steps.
    let register = host.read_u16(1, 60);
    assert_eq!(register >> 10, 1);
    assert!((300..400).contains(&(register & 0x3FF)), "{register:#x}");
}

#[test]
fn a_goal_beyond_the_limits_ends_at_the_limit() {
    let mut host = moving();
    host.write_u16(1, 9, 1900);
    host.write_u16(1, 11, 2200);
    host.write_u16(1, GOAL, 3000);
    host.wait_s(1.0);
    assert!(
        (host.view().position_steps - 2200).abs() <= 3,
        "{:?}",
        host.view()
    );
}

#[test]
fn without_torque_it_falls() {
    let mut host = Host::with_one();
    let load = Load {
        torque_nm: 0.5,
        ..Load::default()
    };
    host.wire
        .bus()
        .servo_mut(0)
        .expect("it is there")
        .set_load(load);
    host.wait_s(0.2);
    assert!(host.view().position_steps > 2148, "{:?}", host.view());
    assert_eq!(host.view().current_a, 0.0);
}

#[test]
fn a_wheel_turns_at_its_speed_both_ways() {
    let mut host = moving();
    host.write(1, MODE, &[1]);
    for (speed, wanted) in [(1000, 1000.0), (1 << 15 | 500, -500.0), (0, 0.0)] {
        host.write_u16(1, SPEED, speed);
        host.wait_s(1.0);
        let is = host.view().speed_steps_s;
        assert!((is - wanted).abs() <= 50.0, "{is} for {wanted}");
    }
}

#[test]
fn pwm_is_the_output_itself() {
    let mut host = moving();
    host.write(1, MODE, &[2]);
    host.write_u16(1, PWM, 1 << 10 | 300);
    host.wait_s(0.5);
    assert_eq!(host.view().duty, -0.3);
    assert!(host.view().speed_steps_s < -500.0);
}

#[test]
fn in_step_mode_a_goal_is_a_number_of_steps_from_here() {
    let mut host = moving();
    host.write(1, MODE, &[3]);
    for way in [300, 300, 1 << 15 | 100] {
        host.write_u16(1, GOAL, way);
        host.wait_s(1.0);
    }
    assert!(
        (host.view().position_steps - 2548).abs() <= 6,
        "{:?}",
        host.view()
    );
}

#[test]
fn the_torque_limit_bounds_the_output() {
    let mut host = moving();
    host.write_u16(1, 48, 100);
    host.write_u16(1, GOAL, 4000);
    for _ in 0..20 {
        host.wait_s(0.05);
        assert!(host.view().duty.abs() <= 0.1);
    }
}
