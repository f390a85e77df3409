//! The joints with the simulated DM4310. Armed joints hold their pose, and what stops them leaves the wheels running.

use robot_app::{
    domain::{ChassisCommand, JointCommand, JointMode},
    safety::{SafetyFlags, SafetyVerdict},
};

use super::*;

fn enabled(robot: &Robot) -> [bool; 4] {
    [0, 1, 2, 3].map(|joint| robot.signal(&format!("can.joint.{joint}.enabled")) == 1.0)
}

fn stop_frames(robot: &Robot) -> f64 {
    let frames = |joint| robot.signal(&format!("can.joint.{joint}.stop_frames"));
    (0..4).map(frames).sum()
}

fn assert_joints_disabled(robot: &Robot) {
    assert_eq!(enabled(robot), [false; 4], "at {} s", robot.seconds());
}

/// Milliseconds until no joint is enabled.
fn ms_until_disabled(robot: &mut Robot) -> f64 {
    let start = robot.seconds();
    let mut last_enabled = start;
    robot.run_until(start + 0.5, |robot| {
        if enabled(robot) != [false; 4] {
            last_enabled = robot.seconds();
        }
    });
    (last_enabled - start) * 1_000.0
}

/// Makes the clearing gesture, enable off and e-stop thrown, for 1.1 s.
fn clear(robot: &mut Robot) {
    let e_stop = |thrown| RemoteInput {
        e_stop: Some(thrown),
        enable: Some(false),
        ..ENABLE
    };
    let now = robot.seconds();
    robot.remote(sticks(0.0, 0.0));
    robot.remote(e_stop(true));
    robot.run_until(now + 1.1, |_| ());
    robot.remote(e_stop(false));
    robot.run_until(now + 1.3, |_| ());
}

#[test]
fn joints_are_released_until_armed_and_then_hold_their_pose() {
    let mut robot = Robot::new(PlantKind::Stand, RadioKind::Sbus);
    robot.run_until(2.5, assert_joints_disabled);
    robot.remote(ENABLE);
    robot.run_until(2.7, |_| ());
    let pose = robot.diagnostics().command.joints;
    robot.run_until(4.0, |robot| assert_eq!(enabled(robot), [true; 4]));
    for (joint, command) in pose.iter().enumerate() {
        let is_rad = robot.signal(&format!("truth.joint.{joint}.pos_rad"));
        assert_eq!(command.mode, JointMode::Mit);
        assert_eq!((command.kp, command.kd), (20.0, 1.0));
        assert!((f64::from(command.pos_rad) - is_rad).abs() < 0.02);
    }
    robot.remote(DISABLE);
    // The frame may start 7 ms later and lasts 3 ms; a joint's slot comes every 2 ms.
    assert!(ms_until_disabled(&mut robot) <= 13.0);
    let before = stop_frames(&robot);
    robot.run_until(robot.seconds() + 0.1, assert_joints_disabled);
    let sent = stop_frames(&robot) - before;
    assert!(
        (sent - 200.0).abs() <= 4.0,
        "{sent} in 100 ms to four joints"
    );
}

/// Each case is `(fault, flag, resumes when the stick is centred)`.
#[test]
fn a_faulty_joint_stops_all_joints_and_the_wheels_continue() {
    let cases = [
        ("motor-3-fault", SafetyFlags::JOINT_FAULT, false),
        ("motor-4-gone", SafetyFlags::JOINT_SILENT, true),
        // Their own time-out of 100 ms is a fault that the drives keep.
        ("can2-empty", SafetyFlags::JOINT_SILENT, false),
    ];
    for (fault, flag, goes_on) in cases {
        let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
        robot.fault(fault, true);
        robot.run_until(6.0, |_| ());
        let safety = robot.diagnostics().safety;
        assert!(safety.flags.intersects(flag), "{fault}: {safety:?}");
        assert_eq!(safety.verdict, SafetyVerdict::PartialStop, "{fault}");
        robot.run_until(6.5, |robot| {
            let obeying = enabled(robot).into_iter().filter(|enabled| *enabled);
            assert_eq!(obeying.count(), 0, "{fault}");
        });
        let speed = robot.signal("truth.wheel.0.speed_mps");
        assert!((speed / 0.6 - 1.0).abs() < 0.05, "{fault}: {speed} m/s");
        robot.fault(fault, false);
        robot.run_until(8.0, |_| ());
        assert_eq!(enabled(&robot), [false; 4], "{fault} over, stick pushed");
        robot.remote(sticks(0.0, 0.0));
        robot.run_until(8.5, |_| ());
        assert_eq!(enabled(&robot), [goes_on; 4], "{fault} over");
        if !goes_on {
            clear(&mut robot);
            robot.remote(ENABLE);
            robot.run_until(robot.seconds() + 1.0, |_| ());
            assert_eq!(enabled(&robot), [true; 4], "{fault} cleared");
        }
    }
}

/// A DM4310 changes its mode while disabled, and may not answer for 150 ms meanwhile.
#[test]
fn a_mode_change_stops_all_joints_briefly() {
    for slow in [false, true] {
        take_a_new_mode(slow);
    }
}

fn take_a_new_mode(slow: bool) {
    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    // With a pushed stick they would wait until it is centred.
    robot.remote(sticks(0.0, 0.0));
    robot.fault("joint-writes-slow", slow);
    let hold = JointCommand {
        mode: JointMode::Mit,
        kp: 20.0,
        kd: 1.0,
        ..JointCommand::default()
    };
    let turn = JointCommand {
        mode: JointMode::Speed,
        vel_rps: 1.0,
        ..JointCommand::default()
    };
    let mut command = ChassisCommand {
        joints: [hold; 4],
        ..ChassisCommand::default()
    };
    robot.direct = Some(command);
    robot.run_until(5.4, |_| ());
    command.joints[2] = turn;
    robot.direct = Some(command);
    let mut silent_ms = 0;
    robot.run_until(6.0, |robot| {
        let safety = robot.diagnostics().safety;
        silent_ms += u32::from(safety.flags.intersects(SafetyFlags::JOINT_SILENT));
        assert!(robot.armed() && !safety.wheels_stop);
    });
    let expected = if slow { 50..200 } else { 0..1 };
    assert!(expected.contains(&silent_ms), "{silent_ms} ms");
    assert_eq!(enabled(&robot), [true; 4]);
    let speed_rps = robot.signal("truth.joint.2.vel_rps");
    assert!((speed_rps - 1.0).abs() < 0.1, "{speed_rps} rad/s");
}

#[test]
fn a_fallen_robot_is_released_until_upright_and_cleared() {
    let mut robot = driving(PlantKind::Rolling, RadioKind::Sbus);
    robot.fault("tilted", true);
    robot.run_until(7.0, |_| ());
    assert!(
        robot
            .diagnostics()
            .safety
            .latched
            .intersects(SafetyFlags::TILT)
    );
    robot.run_until(8.0, |robot| {
        assert_still(robot);
        assert_joints_disabled(robot);
    });
    robot.fault("tilted", false);
    robot.run_until(12.0, |robot| {
        assert_still(robot);
        assert_joints_disabled(robot);
    });
    clear(&mut robot);
    let latched = robot.diagnostics().safety.latched;
    assert!(!latched.intersects(SafetyFlags::TILT), "{latched:?}");
    robot.remote(ENABLE);
    robot.run_until(robot.seconds() + 0.5, |_| ());
    assert_eq!(enabled(&robot), [true; 4]);
}

#[test]
fn a_low_battery_blocks_the_next_drive_and_an_empty_one_ends_the_present() {
    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    robot.fault("battery-low", true);
    robot.run_until(7.0, |_| ());
    assert!(robot.armed());
    let safety = robot.diagnostics().safety;
    assert_eq!(safety.flags, SafetyFlags::BATTERY_LOW);
    robot.remote(sticks(0.0, 0.0));
    robot.remote(DISABLE);
    robot.run_until(7.2, |_| ());
    robot.remote(ENABLE);
    robot.run_until(7.4, assert_limp_later);
    assert_eq!(blockers(&robot), ["enable-not-cycled", "battery-low"]);

    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    robot.fault("battery-empty", true);
    robot.run_until(6.5, |_| ());
    robot.fault("battery-empty", false);
    robot.run_until(8.0, |robot| {
        assert_still(robot);
        assert_joints_disabled(robot);
    });
    let latched = robot.diagnostics().safety.latched;
    assert_eq!(latched, SafetyFlags::BATTERY_EMPTY);
}

fn assert_limp_later(robot: &Robot) {
    if robot.seconds() > 7.25 {
        assert_joints_disabled(robot);
    }
}
