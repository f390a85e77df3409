//! The app drives the simulated robot through its real wire formats.

mod legs;
mod motion;
mod mounting;
mod pc;

use robot_app::safety::{ArmingBlockers, SafetyFlags, SafetyVerdict};
use robot_host_loop::Robot;
use robot_plant::world::{PlantKind, RadioKind, RemoteInput};

const ENABLE: RemoteInput = RemoteInput {
    enable: Some(true),
    e_stop: None,
    vx: None,
    wz: None,
    mode: None,
    left_x: None,
    left_y: None,
    stand: None,
    height: None,
    roll: None,
    jump: None,
};
const DISABLE: RemoteInput = RemoteInput {
    enable: Some(false),
    ..ENABLE
};
const FORWARD: RemoteInput = RemoteInput {
    enable: None,
    vx: Some(0.4),
    ..ENABLE
};

fn sticks(vx: f64, wz: f64) -> RemoteInput {
    RemoteInput {
        vx: Some(vx),
        wz: Some(wz),
        enable: None,
        ..ENABLE
    }
}

fn assert_still(robot: &Robot) {
    assert_eq!(
        robot.wheel_currents_ma(),
        [0.0; 2],
        "at {} s",
        robot.seconds()
    );
}

/// A robot that was enabled at 2.5 s and driven forward from 3 s to 5 s.
fn driving(plant: PlantKind, radio: RadioKind) -> Robot {
    let mut robot = Robot::new(plant, radio);
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    robot.run_until(3.0, |_| ());
    assert!(robot.armed(), "{:?}", blockers(&robot));
    robot.remote(FORWARD);
    robot.run_until(5.0, |_| ());
    robot
}

fn blockers(robot: &Robot) -> Vec<&'static str> {
    robot.diagnostics().arming.blockers.names().collect()
}

/// Seconds until both currents stay zero, observed for `for_s`.
fn seconds_to_zero(robot: &mut Robot, for_s: f64) -> f64 {
    let start = robot.seconds();
    let mut last_torque = start;
    robot.run_until(start + for_s, |robot| {
        if robot.wheel_currents_ma() != [0.0; 2] {
            last_torque = robot.seconds();
        }
    });
    last_torque - start
}

#[test]
fn both_wheels_reach_the_commanded_speed_with_either_radio() {
    for radio in [RadioKind::Sbus, RadioKind::Dbus] {
        let robot = driving(PlantKind::Stand, radio);
        for wheel in ["truth.wheel.0.speed_mps", "truth.wheel.1.speed_mps"] {
            let speed = robot.signal(wheel);
            assert!((speed / 0.6 - 1.0).abs() < 0.05, "{wheel}: {speed} m/s");
        }
    }
}

#[test]
fn arming_follows_the_switch_within_thirty_milliseconds() {
    let mut robot = Robot::new(PlantKind::Stand, RadioKind::Sbus);
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    let mut armed_at = f64::INFINITY;
    robot.run_until(2.6, |robot| {
        if robot.armed() {
            armed_at = armed_at.min(robot.seconds());
        }
    });
    // One radio period of 7 ms, 3 ms of frame, then 30 ms.
    assert!(armed_at < 2.54, "armed at {armed_at} s");
}

#[test]
fn the_switch_off_cuts_the_current() {
    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    robot.remote(DISABLE);
    // The frame that carries it may start 7 ms later and lasts 3 ms; 3 ms for the firmware.
    assert!(seconds_to_zero(&mut robot, 1.0) <= 0.013);
    assert!(!robot.armed());
}

#[test]
fn the_e_stop_cuts_the_current_until_released() {
    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    let e_stop = |e_stop| RemoteInput {
        e_stop: Some(e_stop),
        enable: None,
        ..ENABLE
    };
    robot.remote(e_stop(true));
    assert!(seconds_to_zero(&mut robot, 0.5) <= 0.013);
    assert_eq!(
        robot.diagnostics().safety.verdict,
        SafetyVerdict::GlobalStop
    );
    robot.remote(e_stop(false));
    robot.run_until(6.0, |_| ());
    robot.run_until(7.0, assert_still);
    let blockers = robot.diagnostics().arming.blockers;
    assert!(blockers.contains(ArmingBlockers::ENABLE_NOT_CYCLED));
}

/// `(fault, time until zero)`: age limit 100 ms for the radio, 25 ms for the IMU, half of 64 frames for quality.
#[test]
fn losing_radio_or_imu_cuts_the_current_until_rearmed() {
    let cases = [
        ("sbus-silent", 0.115, SafetyFlags::REMOTE_LOST),
        ("sbus-failsafe", 0.013, SafetyFlags::REMOTE_FAILSAFE),
        ("sbus-frame-lost", 0.115, SafetyFlags::REMOTE_LOST),
        ("imu-gone", 0.035, SafetyFlags::IMU_STALE),
        ("imu-frozen", 0.100, SafetyFlags::IMU_STALE),
    ];
    for (fault, limit_s, flag) in cases {
        let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
        robot.fault(fault, true);
        let zero_s = seconds_to_zero(&mut robot, 1.0);
        assert!(zero_s <= limit_s, "{fault}: {zero_s} s");
        let flags = robot.diagnostics().safety.flags_seen;
        assert!(flags.intersects(flag), "{fault}: {flags:?}");
        robot.fault(fault, false);
        robot.run_until(7.0, assert_still);
    }
}

#[test]
fn one_silent_wheel_stops_nothing() {
    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    robot.fault("motor-0-gone", true);
    robot.run_until(6.0, |_| ());
    let safety = robot.diagnostics().safety;
    assert!(robot.armed());
    assert_eq!(safety.verdict, SafetyVerdict::Run);
    assert!(safety.flags.intersects(SafetyFlags::WHEEL_LEFT_SILENT));
    let right = robot.signal("truth.wheel.1.speed_mps");
    assert!((right / 0.6 - 1.0).abs() < 0.05, "{right} m/s");
}

#[test]
fn a_switch_that_is_on_at_boot_does_not_arm() {
    let mut robot = Robot::new(PlantKind::Stand, RadioKind::Sbus);
    robot.remote(ENABLE);
    robot.run_until(4.0, assert_still);
    assert!(!robot.armed());
    assert_eq!(blockers(&robot), ["enable-not-cycled"]);
}

#[test]
fn a_stick_off_centre_does_not_arm() {
    let mut robot = Robot::new(PlantKind::Stand, RadioKind::Sbus);
    robot.remote(FORWARD);
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    robot.run_until(4.0, assert_still);
    assert_eq!(
        blockers(&robot),
        ["enable-not-cycled", "sticks-not-centred"]
    );
}

/// Compares the plant's truth with the firmware's estimate. The accelerometer's offset (20 mg by the datasheet) alone
/// tilts the horizon by 1.1°.
#[test]
fn rolling_covers_the_commanded_distance_and_turn() {
    let mut robot = Robot::new(PlantKind::Rolling, RadioKind::Sbus);
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    robot.run_until(3.0, |_| ());
    robot.remote(FORWARD);
    robot.run_until(5.0, |_| ());
    robot.remote(sticks(0.0, 0.0));
    robot.run_until(6.0, |_| ());
    robot.remote(sticks(0.0, 0.3));
    robot.run_until(8.0, |_| ());
    robot.remote(sticks(0.0, 0.0));
    robot.run_until(9.0, |_| ());
    let way = robot
        .signal("truth.body.x")
        .hypot(robot.signal("truth.body.y"));
    let turn = robot.signal("truth.body.yaw");
    assert!((way / 1.2 - 1.0).abs() < 0.1, "{way} m of 1.2 m");
    assert!((turn / 2.4 - 1.0).abs() < 0.1, "{turn} rad of 2.4 rad");

    let estimate = robot.diagnostics().estimate;
    let believed = f64::from(estimate.pos_m[0].hypot(estimate.pos_m[1]));
    assert!(
        (believed / way - 1.0).abs() < 0.05,
        "{believed} m of {way} m"
    );
    let [total_deg, _, inclination_deg] = robot.attitude_error_deg();
    assert!(
        total_deg < 5.0 && inclination_deg < 2.0,
        "{total_deg}° {inclination_deg}°"
    );
}

#[test]
fn the_same_run_sends_the_same_bytes() {
    let digest = || driving(PlantKind::Stand, RadioKind::Sbus).sent_digest();
    assert_eq!(digest(), digest());
}
