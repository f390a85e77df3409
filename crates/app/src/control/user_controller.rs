//! The place for your own control algorithm.
//!
//! Write it in `step`: read `input`, set `cmd.wheels[0]` (left) and `[1]` (right) in mA and `cmd.joints[0..4]` (left
//! front, left rear, right front, right rear: mode, angle, speed, gains, torque), and set `cmd_valid`. State goes
//! into the struct; `reset` restores its initial value. The shipped version delegates to the standard controller.
//!
//! The parts of the balance controller are there for yours: where the legs are, the state feedback that the build computed
//! from the robot's file, and the hip torques that give a force along and across a leg. This is balancing on the spot with
//! legs of 0.2 m, without what a real robot needs beside it: trim, contact, limits, a fall.
//!
//! ```
//! use robot_app::control::{ChassisControllerInput, Gains, LegForce, hip_torques_nm, reaction_nm};
//! use robot_app::domain::{ChassisCommand, JointCommand, JointMode, WheelCommand};
//! use robot_app::kinematics::Leg;
//!
//! fn balance(input: &ChassisControllerInput<'_>) -> ChassisCommand {
//!     let (profile, odometry) = (&input.profile.balance, input.wheel_odom_cfg);
//!     let [left_front, left_rear, right_front, right_rear] = &input.sensors.motor.joints;
//!     let left = Leg::measured(&profile.legs, left_front, left_rear);
//!     let right = Leg::measured(&profile.legs, right_front, right_rear);
//!     let ([_, pitch, yaw], [east, north, _]) = (input.estimate.rpy_rad, input.estimate.vel_mps);
//!     let [_, pitch_rate, yaw_rate] = input.sensors.imu.gyro_dps.map(f32::to_radians);
//!     let speed = east * yaw.cos() + north * yaw.sin();
//!     let [left_lean, right_lean] = [left, right].map(|leg| pitch - leg.angle_rad);
//!     let [left_rate, right_rate] = [left, right].map(|leg| pitch_rate - leg.angle_rps);
//!     let [wheel_left, wheel_right, leg_left, leg_right] =
//!         Gains::new(&profile.gains, [left.length_m, right.length_m]).torques_nm(&[
//!             0.0, speed, 0.0, yaw_rate, left_lean, left_rate, right_lean, right_rate, pitch, pitch_rate,
//!         ]);
//!     let hips = |leg: &Leg, wheel_nm, lean_nm| {
//!         let load_n = 0.5 * 9.81 * profile.mass.carried_kg;
//!         let push_n = load_n + 500.0 * (0.2 - leg.length_m) - 30.0 * leg.length_mps;
//!         let [front, rear] = hip_torques_nm(leg, LegForce { push_n, lean_nm });
//!         let [front_share, rear_share] = reaction_nm(leg, wheel_nm);
//!         [front + front_share, rear + rear_share]
//!     };
//!     let joint = |tau_nm| JointCommand { mode: JointMode::Mit, tau_nm, ..Default::default() };
//!     let [left_sign, right_sign] = odometry.rpm_signs();
//!     let wheel = |sign: f32, nm: f32| WheelCommand { current_ma: sign * nm * odometry.ma_per_nm() };
//!     let ([lf, lr], [rf, rr]) = (hips(&left, wheel_left, leg_left), hips(&right, wheel_right, leg_right));
//!     ChassisCommand {
//!         wheels: [wheel(left_sign, wheel_left), wheel(right_sign, wheel_right)],
//!         joints: [lf, lr, rf, rr].map(joint),
//!     }
//! }
//! # use robot_app::domain::{RobotConfig, SensorsSnapshot, StateEstimate, HighLevelCommand, OperatorState, StandPermit, robots};
//! # let config = RobotConfig::default();
//! # let tilted = |pitch_rad: f32| balance(&ChassisControllerInput {
//! #     sensors: &SensorsSnapshot::default(),
//! #     estimate: &StateEstimate { rpy_rad: [0.0, pitch_rad, 0.0], ..StateEstimate::default() },
//! #     wheel_odom_cfg: &config.wheel_odom,
//! #     wheel_ctrl_cfg: &config.wheel_ctrl,
//! #     joint_ctrl_cfg: &config.joint_ctrl,
//! #     profile: &robots::FIVEBAR,
//! #     operator_state: &OperatorState::default(),
//! #     hl_cmd: HighLevelCommand::default(),
//! #     stand: StandPermit::Standing,
//! #     wheels_stopped: false,
//! #     joints_stopped: false,
//! # });
//! # // A robot that leans forward drives forward; its right motor sits mirrored. Upright it rests.
//! # let [left, right] = tilted(0.1).wheels.map(|wheel| wheel.current_ma);
//! # assert!(left > 500.0 && right < -500.0, "{left} {right}");
//! # assert!(tilted(0.0).wheels.iter().all(|wheel| wheel.current_ma.abs() < 1.0));
//! ```

use super::{
    ChassisController, ChassisControllerInput, ChassisControllerOutput, StandardController,
};

/// Your control algorithm.
#[derive(Clone, Copy, Debug, Default)]
pub struct UserController {
    standard: StandardController,
}

impl ChassisController for UserController {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        self.standard.step(input)
    }

    fn reset(&mut self) {
        self.standard.reset();
    }
}
