//! What a joint may be asked for: soft limits, speed, gains and torque, all in joint coordinates.

use super::mit::{KD_MAX, KP_MAX};
use crate::{
    domain::{JointCommand, JointConfig, JointMode},
    math::scalar,
};

/// Where the joint is and how fast it turns.
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

/// What the motor's place in the layout adds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorLimits {
    pub max_torque_nm: f32,
    /// How long the joint may move between the report that a command was made from and the command after it.
    pub horizon_s: f32,
}

/// The command that may leave the board instead of `command`. What is no number in a field that the mode uses makes it
/// `Off`, as does a limit that is no number.
///
/// In MIT mode the torque that the motor will give, `kp`·(p − q) + `kd`·(v − q̇) + τ, is kept within the torque limit by
/// scaling `kp`, `kd` and τ alike, for where the joint is and where it will be at its present speed until the next
/// command; and at or beyond a soft limit it never points outwards. The target stays inside the soft limits; of a joint
/// that is beyond one already, no further out than the joint is, so that holding it there does not throw it back. In the
/// other modes the motor limits torque itself; there the target stays inside the soft limits, and a speed outwards
/// becomes zero at them, or where the joint would be at them before the next command.
pub fn limited(
    command: &JointCommand,
    motion: JointMotion,
    config: &JointConfig,
    motor: MotorLimits,
) -> JointCommand {
    if !is_usable(command, config) {
        return JointCommand::default();
    }
    let vel_rps = within(command.vel_rps, config.max_speed_rps);
    match command.mode {
        JointMode::Off => JointCommand::default(),
        JointMode::Mit => limited_mit(command, vel_rps, motion, config, motor),
        JointMode::PositionSpeed => JointCommand {
            mode: JointMode::PositionSpeed,
            pos_rad: inside(command.pos_rad, config),
            vel_rps: vel_rps.abs(),
            ..JointCommand::default()
        },
        JointMode::Speed => JointCommand {
            mode: JointMode::Speed,
            vel_rps: not_outwards(
                not_outwards(vel_rps, motion, config),
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

fn limited_mit(
    command: &JointCommand,
    vel_rps: f32,
    motion: JointMotion,
    config: &JointConfig,
    motor: MotorLimits,
) -> JointCommand {
    let limit_nm = scalar::max(scalar::min(config.max_torque_nm, motor.max_torque_nm), 0.0);
    let allowed = JointCommand {
        mode: JointMode::Mit,
        pos_rad: no_further_out(command.pos_rad, motion, config),
        vel_rps,
        kp: scalar::clamp(command.kp, 0.0, scalar::clamp(config.max_kp, 0.0, KP_MAX)),
        kd: scalar::clamp(command.kd, 0.0, scalar::clamp(config.max_kd, 0.0, KD_MAX)),
        tau_nm: within(command.tau_nm, limit_nm),
    };
    let torque_nm = predicted_torque_nm(&allowed, motion);
    let later_nm = torque_nm - allowed.kp * motion.vel_rps * motor.horizon_s;
    let largest_nm = scalar::max(torque_nm.abs(), later_nm.abs());
    let scale = if not_outwards(torque_nm, motion, config) != torque_nm {
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

/// What the motor makes of an MIT command.
fn predicted_torque_nm(command: &JointCommand, motion: JointMotion) -> f32 {
    command.kp * (command.pos_rad - motion.pos_rad)
        + command.kd * (command.vel_rps - motion.vel_rps)
        + command.tau_nm
}

/// Zero instead of what would drive the joint past a soft limit that it has reached.
fn not_outwards(value: f32, motion: JointMotion, config: &JointConfig) -> f32 {
    if motion.pos_rad >= config.max_rad {
        scalar::min(value, 0.0)
    } else if motion.pos_rad <= config.min_rad {
        scalar::max(value, 0.0)
    } else {
        value
    }
}

fn inside(pos_rad: f32, config: &JointConfig) -> f32 {
    scalar::clamp(pos_rad, config.min_rad, config.max_rad)
}

/// Inside the soft limits or, beyond one, between the joint and its travel.
fn no_further_out(pos_rad: f32, motion: JointMotion, config: &JointConfig) -> f32 {
    scalar::clamp(
        pos_rad,
        scalar::min(config.min_rad, motion.pos_rad),
        scalar::max(config.max_rad, motion.pos_rad),
    )
}

fn within(value: f32, limit: f32) -> f32 {
    let limit = scalar::max(limit, 0.0);
    scalar::clamp(value, -limit, limit)
}

#[cfg(test)]
mod tests;
