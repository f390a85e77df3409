//! Holds each joint at the angle it had when its motor was enabled.

use crate::domain::{JointCommand, JointControllerConfig, JointFeedback, JointMode, JointState};

/// The held angle of each joint.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PoseHold {
    pose_rad: [Option<f32>; 4],
}

impl PoseHold {
    pub fn step(
        &mut self,
        joints: &[JointFeedback; 4],
        config: &JointControllerConfig,
    ) -> [JointCommand; 4] {
        let mut commands = [JointCommand::default(); 4];
        for ((command, pose_rad), joint) in commands.iter_mut().zip(&mut self.pose_rad).zip(joints)
        {
            *pose_rad = held_angle(*pose_rad, joint);
            if let Some(pos_rad) = *pose_rad {
                *command = hold(pos_rad, config);
            }
        }
        commands
    }
}

/// Follows a joint until its motor is enabled: its leg may sink until then, and must not jump back. Returns `None`
/// while the angle is unknown.
fn held_angle(held_rad: Option<f32>, joint: &JointFeedback) -> Option<f32> {
    let measured_rad = Some(joint.pos_rad).filter(|angle| angle.is_finite());
    match joint.state {
        JointState::Silent | JointState::SettingUp | JointState::Fault => None,
        JointState::Disabled | JointState::Enabling => measured_rad,
        JointState::Enabled => held_rad.or(measured_rad),
    }
}

const fn hold(pos_rad: f32, config: &JointControllerConfig) -> JointCommand {
    JointCommand {
        mode: JointMode::Mit,
        pos_rad,
        vel_rps: 0.0,
        kp: config.hold_kp,
        kd: config.hold_kd,
        tau_nm: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: JointControllerConfig = JointControllerConfig {
        rs00_timeout_set: 0,
        hold_kp: 30.0,
        hold_kd: 2.0,
    };

    fn joints(state: JointState, pos_rad: f32) -> [JointFeedback; 4] {
        [0.0, 0.1, 0.2, 0.3].map(|offset| JointFeedback {
            pos_rad: pos_rad + offset,
            state,
            ..JointFeedback::default()
        })
    }

    fn angles(commands: [JointCommand; 4]) -> [f32; 4] {
        commands.map(|command| {
            assert_eq!(
                (command.mode, command.vel_rps, command.tau_nm),
                (JointMode::Mit, 0.0, 0.0)
            );
            assert_eq!((command.kp, command.kd), (30.0, 2.0));
            command.pos_rad
        })
    }

    #[test]
    fn each_joint_is_held_where_its_motor_was_enabled() {
        let mut hold = PoseHold::default();
        hold.step(&joints(JointState::Disabled, 1.0), &CONFIG);
        hold.step(&joints(JointState::Enabling, 0.9), &CONFIG);
        for pos_rad in [0.8, 0.5, -0.5] {
            let commands = hold.step(&joints(JointState::Enabled, pos_rad), &CONFIG);
            assert_eq!(angles(commands), [0.9, 1.0, 1.1, 1.2]);
        }
    }

    #[test]
    fn an_enabled_joint_is_held_where_it_is_first_seen() {
        let mut hold = PoseHold::default();
        for pos_rad in [0.5, 0.4] {
            let commands = hold.step(&joints(JointState::Enabled, pos_rad), &CONFIG);
            assert_eq!(angles(commands), [0.5, 0.6, 0.7, 0.8]);
        }
    }

    #[test]
    fn a_lost_joint_is_released_and_does_not_jump_back() {
        for lost in [JointState::Silent, JointState::SettingUp, JointState::Fault] {
            let mut hold = PoseHold::default();
            hold.step(&joints(JointState::Enabled, 0.5), &CONFIG);
            let mut feedback = joints(JointState::Enabled, 0.5);
            feedback[1].state = lost;
            let [left, lost, ..] = hold.step(&feedback, &CONFIG);
            assert_eq!((left.mode, left.pos_rad), (JointMode::Mit, 0.5));
            assert_eq!(lost, JointCommand::default());
            let [left, back, ..] = hold.step(&joints(JointState::Enabled, -0.5), &CONFIG);
            assert_eq!((left.pos_rad, back.pos_rad), (0.5, -0.4));
        }
    }

    #[test]
    fn an_angle_that_is_nan_is_not_held() {
        let mut hold = PoseHold::default();
        for state in [JointState::Disabled, JointState::Enabled] {
            let commands = hold.step(&joints(state, f32::NAN), &CONFIG);
            assert_eq!(commands, [JointCommand::default(); 4]);
        }
    }
}
