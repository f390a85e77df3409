//! Conversion between motor and joint coordinates: joint angle = direction · (motor angle − zero).

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

/// `direction` is +1 or −1, so multiplying by it also undoes it.
pub fn motor_targets(joint: &JointCommand, config: &JointConfig) -> MitTargets {
    MitTargets {
        pos_rad: config.zero_rad + config.direction * joint.pos_rad,
        vel_rps: config.direction * joint.vel_rps,
        kp: joint.kp,
        kd: joint.kd,
        torque_nm: config.direction * joint.tau_nm,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::RobotConfig;

    /// A mirrored motor reads 0.5 rad when its joint is at zero, so joint angle 0.3 is motor angle 0.5 − 0.3.
    #[test]
    fn a_mirrored_and_offset_motor_is_converted_both_ways() {
        let [config, ..] = RobotConfig::default().joints;
        let config = JointConfig {
            direction: -1.0,
            zero_rad: 0.5,
            ..config
        };
        let command = JointCommand {
            pos_rad: 0.3,
            vel_rps: 2.0,
            kp: 20.0,
            kd: 1.0,
            tau_nm: 0.7,
            ..JointCommand::default()
        };
        let targets = motor_targets(&command, &config);
        assert!((targets.pos_rad - 0.2).abs() < 1e-6);
        assert_eq!((targets.vel_rps, targets.torque_nm), (-2.0, -0.7));
        assert_eq!((targets.kp, targets.kd), (20.0, 1.0));
        let report = MitReport {
            position_code: 0,
            pos_rad: 0.2,
            vel_rps: -2.0,
            torque_nm: -0.7,
        };
        let motion = joint_motion(&report, &config);
        assert!((motion.pos_rad - 0.3).abs() < 1e-6);
        assert_eq!(motion.vel_rps, 2.0);
        assert_eq!(joint_torque_nm(&report, &config), 0.7);
    }
}
