//! Which motors keep the robot from being armed.

use crate::domain::{JointConfig, JointFeedback, JointState, MotorFeedback, WheelFeedback};

/// Beyond its soft limits a joint may be by this much: legs rest on their mechanical stops.
const SLACK_RAD: f32 = 0.1;

/// Masks, bit 0 = left wheel or left front joint, in the order of `ChassisCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct MotorFindings {
    /// No report since boot.
    pub wheels_unheard: u8,
    /// See `WheelFeedback::doubtful`.
    pub wheels_doubtful: u8,
    /// Silent.
    pub joints_silent: u8,
    /// Silent, not set up, or with a fault.
    pub joints_unready: u8,
    /// At an angle beyond their soft limits.
    pub joints_outside: u8,
}

impl MotorFindings {
    pub fn of(motor: &MotorFeedback, joints: &[JointConfig; 4]) -> Self {
        let mut findings = Self::default();
        for (bit, wheel) in [1u8, 2].into_iter().zip(&motor.wheels) {
            findings.note_wheel(bit, wheel);
        }
        let configs = motor.joints.iter().zip(joints);
        for (bit, (joint, config)) in [1u8, 2, 4, 8].into_iter().zip(configs) {
            findings.note_joint(bit, joint, config);
        }
        findings
    }

    fn note_wheel(&mut self, bit: u8, wheel: &WheelFeedback) {
        if wheel.ts_us == 0 {
            self.wheels_unheard |= bit;
        }
        if wheel.doubtful {
            self.wheels_doubtful |= bit;
        }
    }

    fn note_joint(&mut self, bit: u8, joint: &JointFeedback, config: &JointConfig) {
        match joint.state {
            JointState::Silent => {
                self.joints_silent |= bit;
                self.joints_unready |= bit;
            }
            JointState::SettingUp | JointState::Fault => self.joints_unready |= bit,
            JointState::Disabled | JointState::Enabling | JointState::Enabled => {}
        }
        let travel = config.min_rad - SLACK_RAD..=config.max_rad + SLACK_RAD;
        if joint.ts_us != 0 && !travel.contains(&joint.pos_rad) {
            self.joints_outside |= bit;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::RobotConfig;

    fn heard() -> MotorFeedback {
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

    fn findings(change: impl FnOnce(&mut MotorFeedback)) -> MotorFindings {
        let mut motor = heard();
        change(&mut motor);
        MotorFindings::of(&motor, &RobotConfig::default().joints)
    }

    #[test]
    fn motors_that_answer_and_make_sense_are_found_fit() {
        assert_eq!(findings(|_| ()), MotorFindings::default());
    }

    #[test]
    fn each_wheel_has_its_bit() {
        for (wheel, bit) in [(0, 1), (1, 2)] {
            let unheard = findings(|motor| motor.wheels[wheel].ts_us = 0);
            assert_eq!(unheard.wheels_unheard, bit);
            let doubtful = findings(|motor| motor.wheels[wheel].doubtful = true);
            assert_eq!(doubtful.wheels_doubtful, bit);
            assert_eq!(doubtful.wheels_unheard, 0);
        }
    }

    #[test]
    fn each_joint_has_its_bit_for_each_state() {
        for (joint, bit) in [(0, 1), (1, 2), (2, 4), (3, 8)] {
            for (state, silent, unready) in [
                (JointState::Silent, bit, bit),
                (JointState::SettingUp, 0, bit),
                (JointState::Fault, 0, bit),
                (JointState::Disabled, 0, 0),
                (JointState::Enabling, 0, 0),
                (JointState::Enabled, 0, 0),
            ] {
                let found = findings(|motor| motor.joints[joint].state = state);
                assert_eq!(
                    (found.joints_silent, found.joints_unready),
                    (silent, unready)
                );
            }
        }
    }

    /// The soft limits of the robot's own table are ±1.5 rad.
    #[test]
    fn a_joint_a_little_beyond_its_limits_rests_there_and_one_far_beyond_is_wrong() {
        for (joint, bit) in [(0, 1), (1, 2), (2, 4), (3, 8)] {
            for (pos_rad, outside) in [
                (1.59, 0),
                (-1.59, 0),
                (1.61, bit),
                (-1.61, bit),
                (core::f32::consts::TAU, bit),
                (f32::NAN, bit),
            ] {
                let found = findings(|motor| motor.joints[joint].pos_rad = pos_rad);
                assert_eq!(found.joints_outside, outside, "{pos_rad}");
            }
            // Nothing is known of a joint that has never answered.
            let found = findings(|motor| {
                motor.joints[joint].pos_rad = 3.0;
                motor.joints[joint].ts_us = 0;
            });
            assert_eq!(found.joints_outside, 0);
        }
    }
}
