//! Motor coordinates ↔ joint coordinates: joint angle = direction · (motor angle − zero).

use super::super::{
    joint_limits::JointMotion,
    mit::{MitReport, MitTargets},
};
use crate::domain::{JointCommand, JointConfig};

pub fn joint_motion(motor: &MitReport, config: &JointConfig) -> JointMotion {
    JointMotion {
        pos_rad: config.direction * (motor.pos_rad - config.zero_rad),
        vel_rps: config.direction * motor.vel_rps,
    }
}

pub fn joint_torque_nm(motor: &MitReport, config: &JointConfig) -> f32 {
    config.direction * motor.torque_nm
}

/// `direction` is +1 or −1, so that multiplying with it also undoes it.
pub fn motor_targets(joint: &JointCommand, config: &JointConfig) -> MitTargets {
    MitTargets {
        pos_rad: config.zero_rad + config.direction * joint.pos_rad,
        vel_rps: config.direction * joint.vel_rps,
        kp: joint.kp,
        kd: joint.kd,
        torque_nm: config.direction * joint.tau_nm,
    }
}
