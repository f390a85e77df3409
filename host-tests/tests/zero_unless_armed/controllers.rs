//! Controllers that a user might write.

use robot_app::{
    control::{ChassisController, ChassisControllerInput, ChassisControllerOutput},
    domain::{BalanceStatus, ChassisCommand, JointCommand, WheelCommand},
};

/// A faulty user controller that requests arbitrary commands.
pub struct Rogue {
    pub current_ma: f32,
    pub joint: JointCommand,
    pub balance: BalanceStatus,
}

impl Rogue {
    /// Leaves the joints alone.
    pub fn wheels(current_ma: f32) -> Self {
        Self {
            current_ma,
            joint: JointCommand::default(),
            balance: BalanceStatus::SIT,
        }
    }
}

impl ChassisController for Rogue {
    fn step(&mut self, _: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        let wheels = [self.current_ma, -self.current_ma];
        ChassisControllerOutput {
            cmd: ChassisCommand {
                wheels: wheels.map(|current_ma| WheelCommand { current_ma }),
                joints: [self.joint; 4],
            },
            cmd_valid: true,
            balance: self.balance,
        }
    }

    fn reset(&mut self) {}
}

/// A controller with memory that requests 1 mA more in each tick.
pub struct Integrator(pub f32);

impl ChassisController for Integrator {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        self.0 = if input.wheels_stopped {
            0.0
        } else {
            self.0 + 1.0
        };
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

/// Returns a command and marks it as invalid.
pub struct Unsure(pub Rogue);

impl ChassisController for Unsure {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        ChassisControllerOutput {
            cmd_valid: false,
            ..self.0.step(input)
        }
    }

    fn reset(&mut self) {}
}
