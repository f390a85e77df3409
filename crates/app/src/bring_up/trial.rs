//! A trial of one motor under the dead-man stick, within the limits of bring-up.

use core::f32::consts::TAU;

use super::{
    limits,
    request::{TestMotor, Trial, TrialAction},
    status::TrialState,
};
use crate::{
    domain::{
        ChassisCommand, JointCommand, JointMode, MotorFeedback, WheelCommand, WheelOdomConfig,
    },
    math::scalar,
};

/// Inputs of a trial in one tick.
#[derive(Clone, Copy, Debug)]
pub struct TrialInputs<'a> {
    pub dead_man: DeadMan,
    /// Drive stick, −1…1.
    pub drive: f32,
    pub motor: &'a MotorFeedback,
    pub wheel_odom: &'a WheelOdomConfig,
}

/// The dead-man stick of a fresh frame; unknown with an old one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeadMan {
    Held,
    Released,
    Unknown,
}

/// The motor's last report.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Angle of a joint; 0 for a wheel.
    pos_rad: f32,
    /// Speed at the shaft of joint or wheel.
    vel_rps: f32,
    max_rps: f32,
    age_us: u32,
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The stick must be released for a while. `why` is what ended the torque.
    Locked {
        why: TrialState,
        released_since_us: Option<u64>,
    },
    Ready,
    Active {
        since_us: u64,
        /// Angle of a joint when the stick was taken.
        pose_rad: f32,
    },
}

const LOCKED: Phase = Phase::Locked {
    why: TrialState::ReleaseFirst,
    released_since_us: None,
};

/// Controls the trial. It starts locked: the stick must be seen released while the robot is armed.
#[derive(Clone, Debug)]
pub struct TrialRun {
    phase: Phase,
}

impl Default for TrialRun {
    fn default() -> Self {
        Self { phase: LOCKED }
    }
}

impl TrialRun {
    pub fn reset(&mut self) {
        self.phase = LOCKED;
    }

    pub fn state(&self) -> TrialState {
        match self.phase {
            Phase::Locked { why, .. } => why,
            Phase::Ready => TrialState::Ready,
            Phase::Active { .. } => TrialState::Active,
        }
    }

    /// Returns the command: zero except for the selected motor while the stick is held.
    pub fn step(&mut self, trial: &Trial, inputs: &TrialInputs<'_>, now_us: u64) -> ChassisCommand {
        let motion = motion(trial.motor, inputs);
        self.phase = self.advance(inputs.dead_man, &motion, now_us);
        match self.phase {
            Phase::Active { pose_rad, .. } => command(trial, &motion, pose_rad, inputs.drive),
            Phase::Locked { .. } | Phase::Ready => ChassisCommand::default(),
        }
    }

    fn advance(&self, dead_man: DeadMan, motion: &Motion, now_us: u64) -> Phase {
        match self.phase {
            Phase::Locked {
                why,
                released_since_us,
            } => wait_for_release(why, released_since_us, dead_man, now_us),
            Phase::Ready if dead_man == DeadMan::Held => {
                match release_reason(motion, now_us, now_us) {
                    Some(why) => locked(why),
                    None => Phase::Active {
                        since_us: now_us,
                        pose_rad: motion.pos_rad,
                    },
                }
            }
            Phase::Ready => Phase::Ready,
            Phase::Active { .. } if dead_man != DeadMan::Held => locked(TrialState::ReleaseFirst),
            Phase::Active { since_us, pose_rad } => {
                match release_reason(motion, since_us, now_us) {
                    Some(why) => locked(why),
                    None => Phase::Active { since_us, pose_rad },
                }
            }
        }
    }
}

const fn locked(why: TrialState) -> Phase {
    Phase::Locked {
        why,
        released_since_us: None,
    }
}

fn wait_for_release(
    why: TrialState,
    released_since_us: Option<u64>,
    dead_man: DeadMan,
    now_us: u64,
) -> Phase {
    if dead_man != DeadMan::Released {
        return locked(why);
    }
    let since_us = released_since_us.unwrap_or(now_us);
    if now_us.saturating_sub(since_us) >= limits::RELEASE_US {
        return Phase::Ready;
    }
    Phase::Locked {
        why,
        released_since_us: Some(since_us),
    }
}

/// Returns why the motor must be released, if it must. A NaN speed counts as too fast.
fn release_reason(motion: &Motion, since_us: u64, now_us: u64) -> Option<TrialState> {
    if motion.age_us > limits::FEEDBACK_AGE_US {
        Some(TrialState::Silent)
    } else if !(-motion.max_rps..=motion.max_rps).contains(&motion.vel_rps) {
        Some(TrialState::TooFast)
    } else if now_us.saturating_sub(since_us) > limits::TORQUE_US {
        Some(TrialState::TooLong)
    } else {
        None
    }
}

/// Motion of the selected motor. A motor that does not exist is silent.
fn motion(motor: TestMotor, inputs: &TrialInputs<'_>) -> Motion {
    let nothing = Motion {
        pos_rad: 0.0,
        vel_rps: 0.0,
        max_rps: 0.0,
        age_us: u32::MAX,
    };
    match motor {
        TestMotor::Wheel(index) => match inputs.motor.wheels.get(usize::from(index)) {
            Some(wheel) => Motion {
                vel_rps: f32::from(wheel.rpm) * (TAU / 60.0) / inputs.wheel_odom.gear_ratio,
                max_rps: limits::WHEEL_SPEED_RPS,
                age_us: wheel.age_us,
                ..nothing
            },
            None => nothing,
        },
        TestMotor::Joint(index) => match inputs.motor.joints.get(usize::from(index)) {
            Some(joint) => Motion {
                pos_rad: joint.pos_rad,
                vel_rps: joint.vel_rps,
                max_rps: limits::JOINT_SPEED_RPS,
                age_us: joint.age_us,
            },
            None => nothing,
        },
    }
}

fn command(trial: &Trial, motion: &Motion, pose_rad: f32, drive: f32) -> ChassisCommand {
    let mut command = ChassisCommand::default();
    match trial.motor {
        TestMotor::Wheel(index) => {
            if let Some(wheel) = command.wheels.get_mut(usize::from(index)) {
                *wheel = wheel_command(trial.action, motion, drive);
            }
        }
        TestMotor::Joint(index) => {
            if let Some(joint) = command.joints.get_mut(usize::from(index)) {
                *joint = joint_command(trial.action, motion, pose_rad, drive);
            }
        }
    }
    command
}

/// Fraction of the limit, or `None` for a motor to be held.
fn torque_share(action: TrialAction, drive: f32) -> Option<f32> {
    match action {
        TrialAction::StickTorque => Some(drive.clamp(-1.0, 1.0)),
        TrialAction::FixedTorque(share) => Some(share.clamp(-1.0, 1.0)),
        TrialAction::Hold => None,
    }
}

fn wheel_command(action: TrialAction, motion: &Motion, drive: f32) -> WheelCommand {
    let limit_ma = limits::WHEEL_CURRENT_MA;
    let current_ma = match torque_share(action, drive) {
        Some(share) => share * limit_ma,
        None => scalar::clamp(
            -limits::BRAKE_MA_PER_RPS * motion.vel_rps,
            -limit_ma,
            limit_ma,
        ),
    };
    WheelCommand { current_ma }
}

/// Computes a joint's command. The motor itself computes stiffness and damping, so the target stays close enough to
/// the present angle that both together cannot exceed the limit.
fn joint_command(action: TrialAction, motion: &Motion, pose_rad: f32, drive: f32) -> JointCommand {
    let off = JointCommand {
        mode: JointMode::Mit,
        ..JointCommand::default()
    };
    if let Some(share) = torque_share(action, drive) {
        return JointCommand {
            tau_nm: share * limits::JOINT_TORQUE_NM,
            ..off
        };
    }
    let damping_nm = limits::HOLD_KD * motion.vel_rps;
    let stiffness_nm = scalar::clamp(
        limits::HOLD_KP * (pose_rad - motion.pos_rad),
        damping_nm - limits::HOLD_TORQUE_NM,
        damping_nm + limits::HOLD_TORQUE_NM,
    );
    JointCommand {
        pos_rad: motion.pos_rad + stiffness_nm / limits::HOLD_KP,
        kp: limits::HOLD_KP,
        kd: limits::HOLD_KD,
        ..off
    }
}

#[cfg(test)]
mod tests;
