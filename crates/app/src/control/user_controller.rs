//! The place for your own control algorithm.
//!
//! Write it in `step`: read `input`, set `cmd.wheels[0]` (left) and `[1]` (right) in mA and `cmd.joints[0..4]` (left
//! front, left rear, right front, right rear: mode, angle, speed, gains, torque), and set `cmd_valid`. State goes
//! into the struct; `reset` restores its initial value. The shipped version delegates to the standard controller.

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
