//! The place for your own control algorithm.
//!
//! Write it in `step`: read `input`, set `cmd.wheels[0]` (left) and `[1]` (right) in mA and `cmd.joints[0..4]` (left
//! front, left rear, right front, right rear: mode, angle, speed, gains, torque), and set `cmd_valid`. State goes
//! into the struct; `reset` restores its initial value. The shipped version delegates to the standard controller.
//!
//! The parts of the balance controller are there for yours. This one keeps both legs at 0.2 m below the body:
//!
//! ```
//! use robot_app::control::{ChassisControllerInput, LegForce, hip_torques_nm};
//! use robot_app::domain::{JointCommand, JointMode};
//! use robot_app::kinematics::Leg;
//!
//! fn legs(input: &ChassisControllerInput<'_>) -> [JointCommand; 4] {
//!     let profile = &input.profile.balance;
//!     let [left_front, left_rear, right_front, right_rear] = &input.sensors.motor.joints;
//!     let torques = |front, rear| {
//!         let leg = Leg::measured(&profile.legs, front, rear);
//!         let weight_n = 0.5 * profile.mass.carried_kg * 9.81;
//!         hip_torques_nm(&leg, LegForce {
//!             push_n: weight_n + 500.0 * (0.2 - leg.length_m) - 30.0 * leg.length_mps,
//!             lean_nm: 8.0 * leg.angle_rad + 0.5 * leg.angle_rps,
//!         })
//!     };
//!     let ([lf, lr], [rf, rr]) = (torques(left_front, left_rear), torques(right_front, right_rear));
//!     [lf, lr, rf, rr].map(|tau_nm| JointCommand { mode: JointMode::Mit, tau_nm, ..Default::default() })
//! }
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
