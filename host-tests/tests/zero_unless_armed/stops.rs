//! What stops wheels and joints separately, and what is needed to start again.

use robot_app::domain::{BusErrorState, JointCommand, JointMode};

use super::*;
use crate::{
    bench::Tick,
    motors::Behaviour,
    wire::{JointFrame, Mit},
};

/// A driver of all six motors.
fn driver() -> Rogue {
    Rogue {
        joint: JointCommand {
            mode: JointMode::Mit,
            pos_rad: 0.1,
            kp: 10.0,
            kd: 0.5,
            ..JointCommand::default()
        },
        ..Rogue::wheels(2_000.0)
    }
}

fn ticks(make: Make, phases: &[Phase]) -> Vec<Tick> {
    let mut bench = Bench::new(make, driver());
    bench.run(phases);
    std::mem::take(&mut bench.ticks)
}

/// Wheels pushed, joints obeyed, in the last ticks: two are a slot of each joint.
fn moves(ticks: &[Tick]) -> [bool; 2] {
    let last = &ticks[ticks.len() - 2..];
    [
        last.iter().all(Tick::drives),
        last.iter().any(Tick::enables_joints),
    ]
}

/// Armed and driving for 0.3 s.
fn drive() -> Vec<Phase> {
    vec![good(1_500, false), good(300, true)]
}

#[test]
fn armed_joints_are_enabled_and_follow_commands() {
    for make in [Make::Dm4310, Make::Rs00] {
        let ticks = ticks(make, &drive());
        assert_eq!(moves(&ticks), [true, true], "{make:?}");
        let slots = &ticks[ticks.len() - 2..];
        for joint in 0..4 {
            let frames = slots.iter().filter_map(|tick| tick.joints[joint]);
            let [JointFrame::Mit(mit)] = frames.collect::<Vec<_>>()[..] else {
                panic!("joint {joint} has one slot in two ticks");
            };
            let Mit {
                pos_rad, kp, kd, ..
            } = mit;
            let motor_rad = if joint < 2 { 0.1 } else { -0.1 };
            assert!((pos_rad - motor_rad).abs() < 1e-3, "{pos_rad}");
            assert!((kp - 10.0).abs() < 0.13 && (kd - 0.5).abs() < 0.002);
        }
    }
}

type Cause = fn(&mut Phase);

/// Cause; whether wheels continue; whether joints continue; whether all resumes by itself.
const STOPS: [(&str, Cause, [bool; 2], bool); 15] = [
    (
        "can1 off",
        |p| p.buses[0] = BusErrorState::BusOff,
        [false, true],
        true,
    ),
    (
        "can2 off",
        |p| p.buses[1] = BusErrorState::BusOff,
        [true, false],
        true,
    ),
    (
        "can1 congested",
        |p| p.tx_failures[0] = 21,
        [false, true],
        true,
    ),
    (
        "can2 congested",
        |p| p.tx_failures[1] = 21,
        [true, false],
        true,
    ),
    (
        "wheel hot",
        |p| p.wheels[1] = Behaviour::Hot(120),
        [false, true],
        true,
    ),
    (
        "wheel frozen",
        |p| p.wheels[0] = Behaviour::Frozen,
        [false, true],
        false,
    ),
    (
        "wheel gone",
        |p| p.wheels[0] = Behaviour::Gone,
        [true, true],
        true,
    ),
    (
        "joint hot",
        |p| p.joints[2] = Behaviour::Hot(120),
        [true, false],
        true,
    ),
    (
        "joint gone",
        |p| p.joints[3] = Behaviour::Gone,
        [true, false],
        true,
    ),
    (
        "joint fault",
        |p| p.joints[0] = Behaviour::Fault(0xA),
        [true, false],
        false,
    ),
    (
        "joint frozen",
        |p| p.joints[1] = Behaviour::Frozen,
        [true, false],
        false,
    ),
    ("battery low", |p| p.battery_v = 20.0, [true, true], true),
    ("battery unknown", |p| p.battery_v = 0.0, [true, true], true),
    (
        "battery empty",
        |p| p.battery_v = 18.0,
        [false, false],
        false,
    ),
    (
        "battery nan",
        |p| p.battery_v = f32::NAN,
        [false, false],
        false,
    ),
];

/// Each cause lasts one second. After a latched stop the parts resume after the clearing gesture and the enable switch.
#[test]
fn each_stop_affects_its_own_actuators_and_latches_as_documented() {
    for make in [Make::Dm4310, Make::Rs00] {
        for (name, cause, goes_on, recovers) in STOPS {
            let name = format!("{name}, {make:?}");
            let mut bad = good(1_200, true);
            cause(&mut bad);
            let with_cause = [drive(), vec![bad]].concat();
            assert_eq!(moves(&ticks(make, &with_cause)), goes_on, "{name}");
            let over = [with_cause, vec![good(2_000, true)]].concat();
            let expected = if recovers { [true, true] } else { goes_on };
            assert_eq!(moves(&ticks(make, &over)), expected, "{name}, over");
            let switched = [over.clone(), drive()].concat();
            let expected = [recovers; 2];
            assert_eq!(moves(&ticks(make, &switched)), expected, "{name}, switched");
            let mut gesture = good(1_600, false);
            gesture.e_stop = true;
            let cleared = [over, vec![gesture], drive()].concat();
            assert_eq!(moves(&ticks(make, &cleared)), [true; 2], "{name}, cleared");
        }
    }
}

/// The robot is disarmed, and only causes that end by themselves allow arming again.
#[test]
fn every_cause_blocks_arming() {
    let causes: [(&str, Cause); 14] = [
        ("can1 off", |p| p.buses[0] = BusErrorState::BusOff),
        ("can2 off", |p| p.buses[1] = BusErrorState::BusOff),
        ("can2 congested", |p| p.tx_failures[1] = 21),
        ("late task", |p| p.late_task = true),
        ("wheel hot", |p| p.wheels[1] = Behaviour::Hot(120)),
        ("wheel frozen", |p| p.wheels[0] = Behaviour::Frozen),
        ("joint hot", |p| p.joints[2] = Behaviour::Hot(120)),
        ("joint gone", |p| p.joints[3] = Behaviour::Gone),
        ("joint fault", |p| p.joints[0] = Behaviour::Fault(0xA)),
        ("joint frozen", |p| p.joints[1] = Behaviour::Frozen),
        ("battery low", |p| p.battery_v = 20.9),
        ("battery unknown", |p| p.battery_v = 0.0),
        ("battery empty", |p| p.battery_v = 18.0),
        ("uncalibrated", |p| p.calibrated = false),
    ];
    for make in [Make::Dm4310, Make::Rs00] {
        for (name, cause) in causes {
            let mut phases = drive();
            phases.iter_mut().for_each(cause);
            let ticks = ticks(make, &phases);
            let moved = ticks
                .iter()
                .any(|tick| tick.drives() || tick.enables_joints());
            assert!(!moved, "{name}, {make:?}");
        }
    }
}

/// Within 3 ms of the tick that knows the pilot's request, every slot of every joint carries a stop.
#[test]
fn a_stop_reaches_every_joint_in_its_next_slot() {
    for make in [Make::Dm4310, Make::Rs00] {
        let mut stop = good(10, true);
        stop.e_stop = true;
        let ticks = ticks(make, &[drive(), vec![stop]].concat());
        let after = &ticks[ticks.len() - 10..];
        for tick in after {
            assert_eq!(tick.wheels, [0; 2]);
            let stops = tick.joints.iter().flatten();
            assert!(stops.clone().all(|frame| *frame == JointFrame::Disable));
            assert_eq!(stops.count(), 2);
        }
    }
}

/// The robot lies on its side at boot, or falls while it drives: 4 rad/s for half a second.
#[test]
fn a_fallen_robot_does_not_move_until_upright_and_cleared() {
    let mut lying = good(3_000, false);
    lying.accel = [0.0, 9.81, 0.0];
    let mut try_to_drive = good(300, true);
    try_to_drive.accel = lying.accel;
    let boot = ticks(Make::Dm4310, &[lying.clone(), try_to_drive]);
    assert_eq!(moves(&boot), [false; 2]);

    let mut falling = good(500, true);
    falling.gyro = [229.0, 0.0, 0.0];
    lying.enabled = true;
    let fallen = [drive(), vec![falling, lying]].concat();
    let after = ticks(Make::Dm4310, &fallen);
    assert_eq!(moves(&after[..1_800]), [true; 2]);
    // 0.9 rad are reached after 225 ms; the accelerometer, still upright, holds the estimate back a little.
    assert_eq!(moves(&after[..2_300]), [false; 2]);
    let up_again = [fallen, vec![good(20_000, true)], drive()].concat();
    assert_eq!(moves(&ticks(Make::Dm4310, &up_again)), [false; 2]);
}
