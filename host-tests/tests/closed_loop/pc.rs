//! A PC steers the simulated robot: what its gains ask for is what the simulated motors give.

use robot_app::{
    domain::{JointTarget, PcCommand, WheelTarget},
    safety::SafetyFlags,
};

use super::*;

const PC_MODE: RemoteInput = RemoteInput {
    enable: None,
    mode: Some(1),
    ..ENABLE
};

const KD: f32 = 0.1;

/// Wheel targets in rad/s. The joints are damped.
fn wheels(speeds_rps: [f32; 2]) -> PcCommand {
    PcCommand {
        wheels: speeds_rps.map(|speed_rps| WheelTarget {
            speed_rps,
            kp: 0.0,
            kd: KD,
        }),
        joints: [JointTarget {
            pos_rad: 0.0,
            kp: 0.0,
            kd: 1.0,
        }; 4],
        ..PcCommand::default()
    }
}

/// A robot that was armed in mode PC at 2.5 s, with a PC at rest.
fn armed(plant: PlantKind) -> Robot {
    let mut robot = Robot::new(plant, RadioKind::Sbus);
    robot.remote(PC_MODE);
    robot.pc = Some(wheels([0.0; 2]));
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    robot.run_until(3.0, |_| ());
    assert!(robot.armed(), "{:?}", blockers(&robot));
    robot
}

/// The motor's own torque at its output against Kd · (target − speed of the wheel), both of the simulated robot. The
/// report of the speed is 1 rpm of the rotor fine, which is 0.5 mN·m here, and up to 1 ms old.
#[test]
fn each_wheel_gives_the_torque_that_the_law_asks_for() {
    let mut robot = armed(PlantKind::Stand);
    for targets in [[10.0, 25.0], [-8.0, 4.0], [30.0, -30.0]] {
        robot.pc = Some(wheels(targets));
        robot.run_until(robot.seconds() + 1.5, |_| ());
        for (wheel, target) in targets.into_iter().enumerate() {
            let speed = robot.signal(&format!("truth.wheel.{wheel}.speed_rps"));
            let torque_nm = robot.signal(&format!("truth.wheel.{wheel}.torque_nm"));
            let asked_nm = f64::from(KD) * (f64::from(target) - speed);
            // Dry friction alone takes 0.14 N·m.
            assert!(asked_nm.abs() > 0.14 && asked_nm.signum() == f64::from(target).signum());
            assert!(
                (torque_nm - asked_nm).abs() < 2e-3,
                "wheel {wheel}: {torque_nm} N·m instead of {asked_nm}"
            );
        }
    }
}

/// Both wheels forward roll the robot forward by the wheel's radius of 75 mm; the left one slower turns it left.
#[test]
fn positive_targets_roll_the_robot_forward() {
    let mut robot = armed(PlantKind::Rolling);
    let mut stiff = wheels([10.0; 2]);
    for wheel in &mut stiff.wheels {
        wheel.kd = 1.0;
    }
    robot.pc = Some(stiff);
    robot.run_until(5.0, |_| ());
    let vx_mps = robot.signal("truth.body.vx");
    assert!((0.63..0.76).contains(&vx_mps), "{vx_mps} m/s");
    stiff.wheels[0].speed_rps = 8.0;
    robot.pc = Some(stiff);
    robot.run_until(6.0, |_| ());
    assert!(robot.signal("truth.body.wz") > 0.1);
}

/// A PC that stops in the middle of a motion, for all that it asked for.
#[test]
fn torque_ends_with_the_age_limit_and_comes_back_from_rest_only() {
    let mut robot = armed(PlantKind::Rolling);
    robot.pc = Some(wheels([20.0; 2]));
    robot.run_until(4.0, |_| ());
    robot.pc = None;
    let ms = 1_000.0 * seconds_to_zero(&mut robot, 0.5);
    assert!((90.0..=101.5).contains(&ms), "{ms} ms");
    let flags = |robot: &Robot| robot.diagnostics().safety.flags;
    assert!(flags(&robot).intersects(SafetyFlags::PC_LOST) && robot.armed());
    robot.pc = Some(wheels([20.0; 2]));
    robot.run_until(5.0, assert_still);
    assert!(flags(&robot).intersects(SafetyFlags::PC_AWAITED));
    robot.pc = Some(wheels([0.0; 2]));
    robot.run_until(5.1, |_| ());
    assert!(!flags(&robot).intersects(SafetyFlags::PC_STOP));
    robot.pc = Some(wheels([20.0; 2]));
    robot.run_until(5.5, |_| ());
    assert!(robot.wheel_currents_ma()[0] > 500.0);
}

/// The PC holds the legs where they are and then raises one of them by 0.5 rad within a second.
#[test]
fn a_joint_follows_the_pc_from_where_it_is() {
    let mut robot = armed(PlantKind::Stand);
    let pose = robot
        .diagnostics()
        .sensors
        .motor
        .joints
        .map(|joint| joint.pos_rad);
    let mut command = wheels([0.0; 2]);
    for (joint, pos_rad) in command.joints.iter_mut().zip(pose) {
        *joint = JointTarget {
            pos_rad,
            kp: 40.0,
            kd: 1.0,
        };
    }
    let start = robot.seconds();
    while robot.seconds() < start + 1.0 {
        command.joints[2].pos_rad = pose[2] + 0.5 * (robot.seconds() - start) as f32;
        robot.pc = Some(command);
        robot.run_until(robot.seconds() + 0.01, |_| ());
        assert!(
            !robot
                .diagnostics()
                .safety
                .flags
                .intersects(SafetyFlags::PC_STOP)
        );
    }
    robot.run_until(robot.seconds() + 1.0, |_| ());
    for (joint, pos_rad) in pose.into_iter().enumerate() {
        let target = f64::from(pos_rad) + if joint == 2 { 0.5 } else { 0.0 };
        let is_rad = robot.signal(&format!("truth.joint.{joint}.pos_rad"));
        assert!(
            (is_rad - target).abs() < 0.1,
            "joint {joint}: {is_rad} rad instead of {target}"
        );
    }
}
