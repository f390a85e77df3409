//! Selects the command of this tick and sends it to the motors.

use super::{ControlInputs, ControlLoop};
use crate::{
    control::{ChassisController, ChassisControllerInput, ChassisControllerOutput, pc_law},
    domain::{
        BalanceStatus, ChassisCommand, HighLevelCommand, PcCommand, PcDrive, PcKind, StandSwitch,
        age_us,
    },
    safety::{SafetyFlags, SafetyStatus, TorquePermit},
};

/// The source of this tick's commands.
enum CommandSource<'a> {
    /// No motor may move, or no command is fresh and valid.
    Stop,
    /// The logic bus or bring-up, bypassing the controller.
    Direct(&'a ChassisCommand),
    Control(HighLevelCommand),
    /// The PC, bypassing the controller.
    Pc,
}

/// What is stopped in this tick.
struct Stopped {
    wheels: bool,
    joints: bool,
}

impl<C: ChassisController> ControlLoop<C> {
    pub(super) fn act(
        &mut self,
        inputs: &ControlInputs<'_>,
        permit: Option<&TorquePermit>,
        trial: Option<&ChassisCommand>,
        now_us: u64,
    ) {
        let stopped = Stopped {
            wheels: !self.motors.wheels_may_move(permit),
            joints: !self.motors.joints_may_move(permit),
        };
        let demand = if stopped.wheels && stopped.joints {
            CommandSource::Stop
        } else if let Some(command) = trial {
            CommandSource::Direct(command)
        } else {
            self.demand(inputs, now_us)
        };
        let output;
        let pc_command;
        let mut balance = &BalanceStatus::SIT;
        let wanted = match demand {
            CommandSource::Control(hl_cmd) => {
                output = self.control(inputs, hl_cmd, &stopped);
                if output.cmd_valid {
                    balance = &output.balance;
                    &output.cmd
                } else {
                    &ChassisCommand::STOP
                }
            }
            CommandSource::Direct(command) => {
                self.controller.reset();
                command
            }
            CommandSource::Pc => {
                self.controller.reset();
                pc_command = self.follow_pc(inputs.pc);
                &pc_command
            }
            CommandSource::Stop => {
                self.controller.reset();
                &ChassisCommand::STOP
            }
        };
        // A robot that sits pays for no copy.
        if !(balance.sits() && self.state.balance.sits()) {
            self.state.balance = *balance;
        }
        if self.state.safety.clear_faults {
            self.motors.clear_faults();
        }
        self.frames.clear();
        let (config, balancing) = (&self.config, !balance.sits());
        self.motors
            .compose(wanted, permit, config, balancing, now_us, &mut self.frames);
    }

    fn demand<'a>(&self, inputs: &ControlInputs<'a>, now_us: u64) -> CommandSource<'a> {
        let (safety, logic) = (&self.state.safety, inputs.logic);
        let stale = age_us(logic.ts_us, now_us) > self.config.safety.command_timeout_us;
        let pc_stopped = safety.flags.intersects(SafetyFlags::PC_STOP);
        if stale {
            CommandSource::Stop
        } else if pc_stopped || logic.pc_selected && safety.pc_stop {
            self.without_pc()
        } else if logic.pc_selected {
            match inputs.pc.kind {
                PcKind::Motors => CommandSource::Pc,
                PcKind::Drive => CommandSource::Control(self.with_pc(&inputs.pc.drive)),
            }
        } else if logic.cmd_valid {
            CommandSource::Direct(&logic.cmd)
        } else if logic.hl_valid {
            CommandSource::Control(logic.hl_cmd)
        } else {
            CommandSource::Stop
        }
    }

    /// A robot that stands keeps its balance on the spot.
    fn without_pc<'a>(&self) -> CommandSource<'a> {
        if self.stands() {
            CommandSource::Control(self.with_pc(&PcDrive::default()))
        } else {
            CommandSource::Stop
        }
    }

    /// Only the pilot asks for standing.
    fn with_pc(&self, drive: &PcDrive) -> HighLevelCommand {
        HighLevelCommand {
            vx: drive.vx,
            wz: drive.wz,
            height: drive.height,
            roll: drive.roll,
            jump: drive.jump,
            stand: self.state.operator.stand == StandSwitch::Up,
        }
    }

    pub(super) fn stands(&self) -> bool {
        stands(&self.state.safety, &self.state.balance)
    }

    /// Kept out of line, as most robots are driven by hand.
    #[inline(never)]
    fn follow_pc(&self, pc: &PcCommand) -> ChassisCommand {
        let motor = &self.state.sensors.motor;
        pc_law(pc, motor, &self.config.wheel_odom, &self.config.wheel_ctrl)
    }

    fn control(
        &mut self,
        inputs: &ControlInputs<'_>,
        hl_cmd: HighLevelCommand,
        stopped: &Stopped,
    ) -> ChassisControllerOutput {
        self.controller.step(&ChassisControllerInput {
            sensors: &self.state.sensors,
            estimate: &self.state.estimate,
            wheel_odom_cfg: &self.config.wheel_odom,
            wheel_ctrl_cfg: &self.config.wheel_ctrl,
            joint_ctrl_cfg: &self.config.joint_ctrl,
            profile: self.profile,
            operator_state: &inputs.remote.operator,
            hl_cmd,
            stand: self.state.safety.stand,
            wheels_stopped: stopped.wheels,
            joints_stopped: stopped.joints,
        })
    }
}

/// Whether the robot stands, or may stand up.
pub(super) fn stands(safety: &SafetyStatus, balance: &BalanceStatus) -> bool {
    safety.stand.permits() || !balance.sits()
}
