//! Steps of 10 ms, as the command makes them.

use robot_app::link::{Keys, MotorState, Uplink};

use super::*;

const DT_S: f64 = 0.01;
const WHEELS: Wheels = Wheels {
    radius_m: 0.1,
    track_m: 0.4,
};
const LIMITS: Limits = Limits {
    speed_mps: 0.5,
    turn_rps: 1.0,
    accel_mps2: 0.5,
    turn_accel_rps2: 2.0,
};
const GAINS: Gains = Gains {
    wheel_kd: 1.0,
    joint_kp: 20.0,
    joint_kd: 1.0,
};
const FORWARD: Wish = Wish {
    is_held: true,
    forward: 1.0,
    ..Wish::NONE
};
const LET_GO: Wish = Wish {
    is_held: false,
    forward: 1.0,
    ..Wish::NONE
};

fn driver() -> Driver {
    Driver::new(WHEELS, LIMITS, GAINS)
}

/// A robot with these keys, all of whose joints stand at this angle.
fn robot(keys: Keys, joint_rad: f32) -> RobotView {
    let motor = MotorState {
        pos_rad: joint_rad,
        vel_rps: 0.0,
    };
    let mut view = RobotView::default();
    view.state = Uplink {
        keys,
        motors: [motor; 6],
        ..Uplink::default()
    };
    view
}

fn ready() -> RobotView {
    robot(Keys::B | Keys::F1 | Keys::START, 0.4)
}

fn speeds(command: &Downlink) -> [f32; 2] {
    command.wheels.map(|wheel| wheel.speed_rps)
}

fn is_rest(command: &Downlink) -> bool {
    speeds(command) == [0.0; 2]
}

#[test]
fn the_wheels_follow_a_ramp_while_the_dead_man_is_held() {
    let (mut driver, robot) = (driver(), ready());
    assert!(is_rest(&driver.step(DT_S, LET_GO, &robot)));
    let first = driver.step(DT_S, FORWARD, &robot);
    assert!((speeds(&first)[0] - 0.05).abs() < 1e-6, "{first:?}");
    let last = (0..200)
        .map(|_| driver.step(DT_S, FORWARD, &robot))
        .last()
        .unwrap();
    assert_eq!(speeds(&last), [5.0, 5.0]);
    assert!(is_rest(&driver.step(DT_S, LET_GO, &robot)));
}

#[test]
fn a_turn_to_the_left_turns_the_right_wheel_forward() {
    let (mut driver, robot) = (driver(), ready());
    let turn = Wish {
        is_held: true,
        turn: 1.0,
        ..Wish::NONE
    };
    driver.step(DT_S, LET_GO, &robot);
    let last = (0..100)
        .map(|_| driver.step(DT_S, turn, &robot))
        .last()
        .unwrap();
    assert_eq!(speeds(&last), [-2.0, 2.0]);
}

#[test]
fn nothing_moves_in_another_mode_disarmed_or_without_radio() {
    for keys in [
        Keys::A | Keys::F1,
        Keys::B,
        Keys::B | Keys::F1 | Keys::F2,
        Keys::F1,
    ] {
        let (mut driver, robot) = (driver(), robot(keys, 0.0));
        assert!(robot.obstacle().is_some());
        driver.step(DT_S, LET_GO, &robot);
        let commands = (0..100).map(|_| driver.step(DT_S, FORWARD, &robot));
        assert!(
            commands.into_iter().all(|command| is_rest(&command)),
            "{keys:?}"
        );
    }
}

/// The robot is armed while the user holds the key: it must not start by itself.
#[test]
fn after_a_stop_the_dead_man_counts_only_once_it_was_let_go() {
    let mut driver = driver();
    driver.step(DT_S, LET_GO, &ready());
    driver.step(DT_S, FORWARD, &ready());
    driver.step(DT_S, FORWARD, &robot(Keys::B, 0.4));
    for _ in 0..100 {
        assert!(is_rest(&driver.step(DT_S, FORWARD, &ready())));
        assert!(driver.must_let_go());
    }
    driver.step(DT_S, LET_GO, &ready());
    assert!(!is_rest(&driver.step(DT_S, FORWARD, &ready())));
}

#[test]
fn joints_hold_where_they_stood_when_the_robot_began_to_follow() {
    let mut driver = driver();
    let disarmed = robot(Keys::B, 0.7);
    let angles = |command: Downlink| command.joints.map(|joint| joint.pos_rad);
    assert_eq!(angles(driver.step(DT_S, LET_GO, &disarmed)), [0.7; 4]);
    assert_eq!(angles(driver.step(DT_S, LET_GO, &ready())), [0.4; 4]);
    let moved = robot(Keys::B | Keys::F1, 0.45);
    assert_eq!(angles(driver.step(DT_S, LET_GO, &moved)), [0.4; 4]);
    assert_eq!(angles(driver.rest(&moved)), [0.45; 4]);
}

/// The robot takes a PC that turns its wheels and repeats itself for a frozen one.
#[test]
fn no_frame_is_the_same_as_the_one_before() {
    let (mut driver, robot) = (driver(), ready());
    driver.step(DT_S, LET_GO, &robot);
    let frames: Vec<_> = (0..1_000)
        .map(|_| driver.step(DT_S, FORWARD, &robot).encode())
        .collect();
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]));
}
