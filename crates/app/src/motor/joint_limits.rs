//! Limits of joint commands: soft limits, speed, gains and torque, all in joint coordinates.

use super::mit::{KD_MAX, KP_MAX};
use crate::{
    domain::{JointCommand, JointConfig, JointMode},
    math::scalar,
};

/// Angle and speed of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointMotion {
    pub pos_rad: f32,
    pub vel_rps: f32,
}

impl JointMotion {
    fn after(self, seconds: f32) -> Self {
        Self {
            pos_rad: self.pos_rad + self.vel_rps * seconds,
            ..self
        }
    }
}

/// Limits given by the motor's place in the layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorLimits {
    pub max_torque_nm: f32,
    /// Longest time in s between the report that a command was computed from and the next command.
    pub horizon_s: f32,
}

/// Returns the command that may be sent instead of `command`. NaN in a field that the mode uses, or in a limit, makes
/// it `Off`.
///
/// In MIT mode the motor's torque is `kp`·(p − q) + `kd`·(v − q̇) + τ. The function scales `kp`, `kd` and τ alike
/// until this torque is within its limit, both at the present position and at the position that the joint reaches by
/// the next command at its present speed. At or beyond a soft limit the torque never points outwards, and at or above
/// the speed limit it never accelerates. The target
/// stays inside the soft limits. A joint that is already beyond one may keep its present angle as its target, so that
/// holding it does not throw it back.
///
/// In the other modes the motor limits torque itself. The target angle stays inside the soft limits. A speed outwards
/// becomes zero at a soft limit, or where the joint would reach it before the next command.
pub fn limit_command(
    command: &JointCommand,
    motion: JointMotion,
    config: &JointConfig,
    motor: MotorLimits,
) -> JointCommand {
    if !is_usable(command, config) {
        return JointCommand::default();
    }
    let vel_rps = clamp_magnitude(command.vel_rps, config.max_speed_rps);
    match command.mode {
        JointMode::Off => JointCommand::default(),
        JointMode::Mit => limit_mit(command, vel_rps, motion, config, motor),
        JointMode::PositionSpeed => JointCommand {
            mode: JointMode::PositionSpeed,
            pos_rad: within_soft_limits(command.pos_rad, config),
            vel_rps: vel_rps.abs(),
            ..JointCommand::default()
        },
        JointMode::Speed => JointCommand {
            mode: JointMode::Speed,
            vel_rps: zero_if_outwards(
                zero_if_outwards(vel_rps, motion, config),
                motion.after(motor.horizon_s),
                config,
            ),
            ..JointCommand::default()
        },
    }
}

fn is_usable(command: &JointCommand, config: &JointConfig) -> bool {
    let fields_ok = match command.mode {
        JointMode::Off => true,
        JointMode::Mit => {
            let sum = command.pos_rad + command.vel_rps + command.kp + command.kd + command.tau_nm;
            !sum.is_nan()
        }
        JointMode::PositionSpeed => !(command.pos_rad + command.vel_rps).is_nan(),
        JointMode::Speed => !command.vel_rps.is_nan(),
    };
    let limits = config.max_torque_nm + config.max_speed_rps + config.max_kp + config.max_kd;
    fields_ok && !limits.is_nan() && config.min_rad <= config.max_rad
}

fn limit_mit(
    command: &JointCommand,
    vel_rps: f32,
    motion: JointMotion,
    config: &JointConfig,
    motor: MotorLimits,
) -> JointCommand {
    let limit_nm = scalar::max(scalar::min(config.max_torque_nm, motor.max_torque_nm), 0.0);
    let allowed = JointCommand {
        mode: JointMode::Mit,
        pos_rad: clamp_not_outwards(command.pos_rad, motion, config),
        vel_rps,
        kp: scalar::clamp(command.kp, 0.0, scalar::clamp(config.max_kp, 0.0, KP_MAX)),
        kd: scalar::clamp(command.kd, 0.0, scalar::clamp(config.max_kd, 0.0, KD_MAX)),
        tau_nm: clamp_magnitude(command.tau_nm, limit_nm),
    };
    let torque_nm = predicted_torque_nm(&allowed, motion);
    let later_nm = torque_nm - allowed.kp * motion.vel_rps * motor.horizon_s;
    let largest_nm = scalar::max(torque_nm.abs(), later_nm.abs());
    let is_fast = motion.vel_rps.abs() >= config.max_speed_rps;
    let accelerates = is_fast && torque_nm * motion.vel_rps > 0.0;
    let scale = if accelerates || zero_if_outwards(torque_nm, motion, config) != torque_nm {
        0.0
    } else if largest_nm > limit_nm {
        limit_nm / largest_nm
    } else {
        return allowed;
    };
    JointCommand {
        kp: allowed.kp * scale,
        kd: allowed.kd * scale,
        tau_nm: allowed.tau_nm * scale,
        ..allowed
    }
}

/// The torque in N·m that the motor computes from an MIT command.
fn predicted_torque_nm(command: &JointCommand, motion: JointMotion) -> f32 {
    command.kp * (command.pos_rad - motion.pos_rad)
        + command.kd * (command.vel_rps - motion.vel_rps)
        + command.tau_nm
}

/// Returns `value`, or zero if it would drive the joint beyond a soft limit that it has reached.
fn zero_if_outwards(value: f32, motion: JointMotion, config: &JointConfig) -> f32 {
    if motion.pos_rad >= config.max_rad {
        scalar::min(value, 0.0)
    } else if motion.pos_rad <= config.min_rad {
        scalar::max(value, 0.0)
    } else {
        value
    }
}

fn within_soft_limits(pos_rad: f32, config: &JointConfig) -> f32 {
    scalar::clamp(pos_rad, config.min_rad, config.max_rad)
}

/// Clamps an angle to the soft limits, extended to the joint's present angle if that lies beyond one.
fn clamp_not_outwards(pos_rad: f32, motion: JointMotion, config: &JointConfig) -> f32 {
    scalar::clamp(
        pos_rad,
        scalar::min(config.min_rad, motion.pos_rad),
        scalar::max(config.max_rad, motion.pos_rad),
    )
}

fn clamp_magnitude(value: f32, limit: f32) -> f32 {
    let limit = scalar::max(limit, 0.0);
    scalar::clamp(value, -limit, limit)
}

#[cfg(test)]
mod tests;
