//! Controllers that a user might write.

use robot_app::{
    control::{ChassisController, ChassisControllerInput, ChassisControllerOutput},
    domain::{ChassisCommand, WheelCommand},
};

/// A user's controller gone wrong: asks for whatever it is told.
pub struct Rogue(pub f32);

impl ChassisController for Rogue {
    fn step(&mut self, _: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        ChassisControllerOutput {
            cmd: ChassisCommand {
                wheels: [
                    WheelCommand { current_ma: self.0 },
                    WheelCommand {
                        current_ma: -self.0,
                    },
                ],
                ..ChassisCommand::default()
            },
            cmd_valid: true,
        }
    }

    fn reset(&mut self) {}
}

/// A controller with memory: asks for 1 mA more each tick.
pub struct Integrator(pub f32);

impl ChassisController for Integrator {
    fn step(&mut self, _: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        self.0 += 1.0;
        let mut output = ChassisControllerOutput {
            cmd_valid: true,
            ..ChassisControllerOutput::default()
        };
        output.cmd.wheels[0].current_ma = self.0;
        output
    }

    fn reset(&mut self) {
        self.0 = 0.0;
    }
}
