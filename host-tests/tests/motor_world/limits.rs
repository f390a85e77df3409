//! No command of the controller exceeds the joints' limits.

use std::array;

use robot_app::domain::{JointCommand, JointMode};
use robot_plant::robots::JointMotor;

use crate::robot::Robot;

const BOTH: [JointMotor; 2] = [JointMotor::Dm4310, JointMotor::Rs00];
/// Default of `JointConfig`.
const MAX_TORQUE_NM: f64 = 5.0;
/// The same.
const MAX_SPEED_RPS: f64 = 15.0;
/// Left front, left rear, right front, right rear.
const RANGE_RAD: [[f64; 2]; 4] = [[-1.35, 0.75], [-0.75, 1.35], [-1.35, 0.75], [-0.75, 1.35]];
/// By this a motor may exceed its limit for a moment while it brakes, and at the limits of speed and angle, where the
/// firmware takes its torque away and gives it again. It slows down by up to 0.13 rad/s or 10 mrad more or less than
/// its last report tells, which 5 N·m·s/rad or 50 N·m/rad turn into torque. An RS00 that is asked for its faults is told
/// nothing new for another 2 ms.
const BRAKING_NM: f64 = 0.65;
const RS00_BRAKING_NM: f64 = 2.0 * BRAKING_NM;

fn mit(pos_rad: f32, vel_rps: f32, kp: f32, kd: f32, tau_nm: f32) -> JointCommand {
    JointCommand {
        mode: JointMode::Mit,
        pos_rad,
        vel_rps,
        kp,
        kd,
        tau_nm,
    }
}

/// What the motor itself makes of its last command in every tick, while the leg flies. The codes cut off up to a step of
/// each field, and 100 N·m/rad turns a step of the angle into 0.04 N·m.
#[test]
fn torque_stays_within_its_limit() {
    for (kind, braking_nm) in BOTH.into_iter().zip([BRAKING_NM, RS00_BRAKING_NM]) {
        let mut robot = Robot::armed(kind);
        for command in [
            mit(0.7, 0.0, 1e9, 0.0, 0.0),
            mit(-0.7, 0.0, 100.0, 1.0, -1e9),
            mit(0.0, 30.0, 20.0, 5.0, 50.0),
            mit(0.0, -30.0, 0.0, 5.0, -50.0),
            mit(0.5, 0.0, 80.0, 2.0, 100.0),
        ] {
            let (mut largest_driving, mut largest_braking) = (0.0_f64, 0.0_f64);
            robot.command_joints(command);
            robot.run_watching(0.3, |robot| {
                let pos_rad = robot.joint_signals("truth.joint.{}.pos_rad");
                let vel_rps = robot.joint_signals("truth.joint.{}.vel_rps");
                let torque_nm = robot.joint_signals("can.joint.{}.torque_nm");
                for joint in 0..4 {
                    let [min_rad, max_rad] = RANGE_RAD[joint];
                    let direction = if joint < 2 { 1.0 } else { -1.0 };
                    let drives = direction * torque_nm[joint] * vel_rps[joint] >= 0.0
                        && (min_rad..max_rad).contains(&pos_rad[joint])
                        && vel_rps[joint].abs() < MAX_SPEED_RPS - 1.0;
                    let largest = if drives {
                        &mut largest_driving
                    } else {
                        &mut largest_braking
                    };
                    *largest = largest.max(torque_nm[joint].abs());
                }
            });
            let said = format!("{kind:?} {command:?} {largest_driving} {largest_braking}");
            assert!(largest_driving < MAX_TORQUE_NM + 0.15, "{said}");
            assert!(largest_braking < MAX_TORQUE_NM + braking_nm, "{said}");
            let largest = largest_driving.max(largest_braking);
            assert!(largest > MAX_TORQUE_NM - 0.2, "{said}");
        }
    }
}

#[test]
fn a_joint_stops_at_its_soft_limit() {
    for kind in BOTH {
        for command in [
            mit(9.0, 0.0, 60.0, 3.0, 0.0),
            JointCommand {
                mode: JointMode::PositionSpeed,
                pos_rad: 9.0,
                vel_rps: 2.0,
                ..JointCommand::default()
            },
            JointCommand {
                mode: JointMode::Speed,
                vel_rps: 2.0,
                ..JointCommand::default()
            },
        ] {
            let mut robot = Robot::armed(kind);
            robot.command_joints(command);
            let mut farthest_rad = [0.0_f64; 4];
            robot.run_watching(3.0, |robot| {
                let now_rad = robot.joint_signals("truth.joint.{}.pos_rad");
                farthest_rad = array::from_fn(|joint| farthest_rad[joint].max(now_rad[joint]));
            });
            for (farthest, [_, limit]) in farthest_rad.into_iter().zip(RANGE_RAD) {
                let said = format!("{kind:?} {:?} {farthest} of {limit}", command.mode);
                assert!(farthest > limit - 0.2, "{said}");
                assert!(farthest < limit + 0.15, "{said}");
            }
        }
    }
}

#[test]
fn beyond_a_soft_limit_nothing_pushes_further_out() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        robot.command_joints(mit(0.0, 0.0, 0.0, 0.0, 3.0));
        let mut was_beyond = false;
        let mut ticks_beyond = [0; 4];
        robot.run_watching(2.0, |robot| {
            for (joint, ticks) in ticks_beyond.iter_mut().enumerate() {
                *ticks = if robot.joint(joint).pos_rad >= RANGE_RAD[joint][1] as f32 {
                    *ticks + 1
                } else {
                    0
                };
                // A joint gets a command in every second tick.
                if *ticks < 2 {
                    continue;
                }
                was_beyond = true;
                let direction = if joint < 2 { 1.0 } else { -1.0 };
                let asked = direction * robot.signal(&format!("can.joint.{joint}.torque_nm"));
                // Half a step of the torque code.
                assert!(asked < 5e-3, "{kind:?} {joint}: {asked}");
            }
        });
        assert!(was_beyond);
    }
}

#[test]
fn a_nan_command_gives_no_torque() {
    let nan = f32::NAN;
    for kind in BOTH {
        for command in [
            mit(nan, 0.0, 20.0, 1.0, 0.0),
            mit(0.0, nan, 20.0, 1.0, 0.0),
            mit(0.0, 0.0, nan, 1.0, 1.0),
            mit(0.0, 0.0, 20.0, nan, 1.0),
            mit(0.0, 0.0, 20.0, 1.0, nan),
        ] {
            let mut robot = Robot::armed(kind);
            robot.command_joints(command);
            robot.run_watching(0.05, |robot| {
                for torque_nm in robot.joint_signals("can.joint.{}.torque_nm") {
                    assert!(torque_nm.abs() < 5e-3, "{kind:?} {command:?} {torque_nm}");
                }
            });
        }
    }
}
