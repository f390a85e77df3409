//! Determines which motors block arming.

use crate::domain::{JointConfig, JointFeedback, JointState, MotorFeedback, WheelFeedback};

/// Tolerance beyond a joint's soft limits, as legs rest on their mechanical stops.
const TOLERANCE_RAD: f32 = 0.1;

/// Masks of motors. Bit 0 is the left wheel or the left front joint, in the order of `ChassisCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct MotorReadiness {
    /// Wheels that have not reported since boot.
    pub wheels_unheard: u8,
    /// Wheels whose angle contradicts their speed; see `WheelFeedback::doubtful`.
    pub wheels_doubtful: u8,
    /// Joints that do not reply.
    pub joints_silent: u8,
    /// Joints that do not reply, are not set up, or have a fault.
    pub joints_unready: u8,
    /// Joints at an angle beyond their soft limits.
    pub joints_outside: u8,
}

impl MotorReadiness {
    /// Assesses all motors.
    pub fn assess(motor: &MotorFeedback, joints: &[JointConfig; 4]) -> Self {
        let mut readiness = Self::default();
        for (bit, wheel) in [1u8, 2].into_iter().zip(&motor.wheels) {
            readiness.assess_wheel(bit, wheel);
        }
        let configs = motor.joints.iter().zip(joints);
        for (bit, (joint, config)) in [1u8, 2, 4, 8].into_iter().zip(configs) {
            readiness.assess_joint(bit, joint, config);
        }
        readiness
    }

    fn assess_wheel(&mut self, bit: u8, wheel: &WheelFeedback) {
        if wheel.ts_us == 0 {
            self.wheels_unheard |= bit;
        }
        if wheel.doubtful {
            self.wheels_doubtful |= bit;
        }
    }

    fn assess_joint(&mut self, bit: u8, joint: &JointFeedback, config: &JointConfig) {
        match joint.state {
            JointState::Silent => {
                self.joints_silent |= bit;
                self.joints_unready |= bit;
            }
            JointState::SettingUp | JointState::Fault => self.joints_unready |= bit,
            JointState::Disabled | JointState::Enabling | JointState::Enabled => {}
        }
        let travel = config.min_rad - TOLERANCE_RAD..=config.max_rad + TOLERANCE_RAD;
        if joint.ts_us != 0 && !travel.contains(&joint.pos_rad) {
            self.joints_outside |= bit;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::RobotConfig;

    fn healthy() -> MotorFeedback {
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            wheel.ts_us = 1_000;
        }
        for joint in &mut motor.joints {
            joint.ts_us = 1_000;
            joint.state = JointState::Disabled;
        }
        motor
    }

    fn readiness(change: impl FnOnce(&mut MotorFeedback)) -> MotorReadiness {
        let mut motor = healthy();
        change(&mut motor);
        MotorReadiness::assess(&motor, &RobotConfig::default().joints)
    }

    #[test]
    fn healthy_motors_are_ready() {
        assert_eq!(readiness(|_| ()), MotorReadiness::default());
    }

    #[test]
    fn each_wheel_has_its_own_bit() {
        for (wheel, bit) in [(0, 1), (1, 2)] {
            let unheard = readiness(|motor| motor.wheels[wheel].ts_us = 0);
            assert_eq!(unheard.wheels_unheard, bit);
            let doubtful = readiness(|motor| motor.wheels[wheel].doubtful = true);
            assert_eq!(doubtful.wheels_doubtful, bit);
            assert_eq!(doubtful.wheels_unheard, 0);
        }
    }

    #[test]
    fn each_joint_has_its_own_bit_for_each_state() {
        for (joint, bit) in [(0, 1), (1, 2), (2, 4), (3, 8)] {
            for (state, silent, unready) in [
                (JointState::Silent, bit, bit),
                (JointState::SettingUp, 0, bit),
                (JointState::Fault, 0, bit),
                (JointState::Disabled, 0, 0),
                (JointState::Enabling, 0, 0),
                (JointState::Enabled, 0, 0),
            ] {
                let found = readiness(|motor| motor.joints[joint].state = state);
                assert_eq!(
                    (found.joints_silent, found.joints_unready),
                    (silent, unready)
                );
            }
        }
    }

    /// The default soft limits are −1.35…0.75 rad at the front and −0.75…1.35 rad at the rear.
    #[test]
    fn a_joint_may_be_slightly_beyond_its_limits() {
        for (joint, bit, sign) in [(0, 1, 1.0), (1, 2, -1.0), (2, 4, 1.0), (3, 8, -1.0)] {
            for (pos_rad, outside) in [
                (sign * 0.84, 0),
                (sign * -1.44, 0),
                (sign * 0.86, bit),
                (sign * -1.46, bit),
                (core::f32::consts::TAU, bit),
                (f32::NAN, bit),
            ] {
                let found = readiness(|motor| motor.joints[joint].pos_rad = pos_rad);
                assert_eq!(found.joints_outside, outside, "{pos_rad}");
            }
            // The angle of a joint that has never replied is unknown.
            let found = readiness(|motor| {
                motor.joints[joint].pos_rad = 3.0;
                motor.joints[joint].ts_us = 0;
            });
            assert_eq!(found.joints_outside, 0);
        }
    }
}
