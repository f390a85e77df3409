//! A PC moves the robot only from rest: after arming, after the choice of mode PC, after a loss and after any other stop
//! its first command must ask for no motion. A gap never continues a motion by itself.

use super::{SafetyFlags, resume_interlock::WATCHED};
use crate::domain::{
    JointFeedback, JointState, JointTarget, MotorFeedback, PcCommand, PcDrive, PcKind,
    SafetyConfig, WheelTarget, age_us,
};

/// A wheel whose target is at most this fast is at rest.
const REST_RPS: f32 = 0.05;
/// A joint whose target is at most this far from its measured angle is at rest.
const REST_RAD: f32 = 0.1;

/// A speed or turn of at most this share of the highest is rest.
const REST_SHARE: f32 = 0.01;

/// What decides about the PC in one tick.
#[derive(Clone, Copy, Debug)]
pub struct PcInputs<'a> {
    /// The newest command.
    pub command: &'a PcCommand,
    /// The mode switch is at PC, and bring-up is off.
    pub mode: bool,
    /// The robot was armed in the last tick, and the logic bus selects the PC.
    pub steering: bool,
    /// The robot stands, or may stand up. Then targets for motors do not count.
    pub stands: bool,
}

/// Remembers whether the PC has sent a command from rest.
#[derive(Clone, Debug, Default)]
pub(super) struct PcInterlock {
    released: bool,
    kind: PcKind,
    /// The conditions of the last tick that stopped something.
    stopped: SafetyFlags,
    /// The joints that were enabled in the last tick.
    enabled: [bool; 4],
}

impl PcInterlock {
    /// Takes the conditions that are `present`, and returns those that stop the PC. Both flags stand for zero torque.
    /// Without one of them, the PC's command may act in mode PC.
    pub fn step(
        &mut self,
        inputs: &PcInputs<'_>,
        present: SafetyFlags,
        config: &SafetyConfig,
        motor: &MotorFeedback,
        now_us: u64,
    ) -> SafetyFlags {
        if inputs.mode {
            self.watch(inputs, present, config, motor, now_us)
        } else {
            self.released = false;
            SafetyFlags::NONE
        }
    }

    /// Whether the PC's command may act.
    pub const fn is_released(&self) -> bool {
        self.released
    }

    /// Kept out of line, as most robots are driven by hand.
    #[inline(never)]
    fn watch(
        &mut self,
        inputs: &PcInputs<'_>,
        present: SafetyFlags,
        config: &SafetyConfig,
        motor: &MotorFeedback,
        now_us: u64,
    ) -> SafetyFlags {
        let stopped = present.intersection(WATCHED);
        let resumed = !self.stopped.difference(stopped).is_empty();
        self.stopped = stopped;
        let joint_jumps = self.note_enabled(inputs.command, motor);
        if is_lost(inputs.command, config, now_us) {
            self.released = false;
            return SafetyFlags::PC_LOST;
        }
        let kind = inputs.command.kind;
        let other_kind = core::mem::replace(&mut self.kind, kind) != kind;
        if inputs.stands && kind == PcKind::Motors {
            self.released = false;
            return SafetyFlags::PC_AWAITED;
        }
        let obeyed = inputs.steering && !present.intersects(SafetyFlags::COMMAND_STALE);
        let goes_on = self.released && obeyed && !resumed && !joint_jumps && !other_kind;
        self.released = goes_on || is_from_rest(inputs.command, motor);
        if self.released {
            SafetyFlags::NONE
        } else {
            SafetyFlags::PC_AWAITED
        }
    }

    /// Returns whether a joint has just been enabled, and would jump. A motor is enabled some time after its first
    /// command, and its leg may have sunk meanwhile.
    fn note_enabled(&mut self, command: &PcCommand, motor: &MotorFeedback) -> bool {
        let mut jumps = false;
        let joints = command.joints.iter().zip(&motor.joints);
        for ((target, joint), was_enabled) in joints.zip(&mut self.enabled) {
            let is_enabled = joint.state == JointState::Enabled;
            jumps |= is_enabled && !*was_enabled && !joint_rests(target, joint);
            *was_enabled = is_enabled;
        }
        jumps && command.kind == PcKind::Motors
    }
}

/// Whether the command is too old, from the future, or that of a PC that turns the wheels and repeats itself.
fn is_lost(command: &PcCommand, config: &SafetyConfig, now_us: u64) -> bool {
    let age = age_us(command.ts_us, now_us);
    let unchanged_us = age_us(command.changed_us, now_us);
    let frozen =
        config.pc_frozen_us != 0 && unchanged_us >= config.pc_frozen_us && !is_at_rest(command);
    age > config.pc_timeout_us || command.ts_us > now_us || frozen
}

/// NaN in a target or in a measured angle is no rest.
fn is_from_rest(command: &PcCommand, motor: &MotorFeedback) -> bool {
    let mut joints = command.joints.iter().zip(&motor.joints);
    is_at_rest(command)
        && (command.kind == PcKind::Drive
            || joints.all(|(target, joint)| joint_rests(target, joint)))
}

/// Whether the command asks for no rolling.
fn is_at_rest(command: &PcCommand) -> bool {
    let PcDrive { vx, wz, .. } = command.drive;
    match command.kind {
        PcKind::Motors => command.wheels.iter().all(wheel_rests),
        PcKind::Drive => vx.abs() <= REST_SHARE && wz.abs() <= REST_SHARE,
    }
}

fn wheel_rests(target: &WheelTarget) -> bool {
    target.speed_rps.abs() <= REST_RPS || target.kd == 0.0
}

fn joint_rests(target: &JointTarget, joint: &JointFeedback) -> bool {
    (target.pos_rad - joint.pos_rad).abs() <= REST_RAD || target.kp == 0.0
}
