//! Terms of an rl_sar configuration.

use super::{ConfigError, keys::Keys};
use crate::{Drive, Joint, Source, TermPlan};

const NO_CLIP: [f32; 2] = [f32::MIN, f32::MAX];
/// Terms of rl_sar that follow a recorded motion.
const OF_MOTIONS: [&str; 3] = [
    "whole_body_tracking/motion_command",
    "whole_body_tracking/motion_anchor_ori_b",
    "RoboMimic_Deploy/phase",
];
const KNOWN: [&str; 8] = [
    "lin_vel",
    "ang_vel",
    "gravity_vec",
    "commands",
    "dof_pos",
    "dof_vel",
    "wheel_joint_vel",
    "actions",
];

/// What terms are made of.
pub(super) struct Terms<'a> {
    keys: &'a Keys,
    joints: &'a [Joint],
    clip_after: [f32; 2],
    /// Joints in `dof_pos` and `dof_vel`.
    dofs: Vec<usize>,
    wheels: Vec<usize>,
}

impl<'a> Terms<'a> {
    /// With `wheel_joint_vel` in a list, `dof_pos` and `dof_vel` hold the joints without the wheels.
    pub(super) fn new(
        keys: &'a Keys,
        joints: &'a [Joint],
        lists: &[&[String]],
    ) -> Result<Self, ConfigError> {
        let clip: f32 = keys.get("clip_obs", "the largest absolute value of an observation")?;
        if clip <= 0.0 {
            return Err(keys.complaint(
                "clip_obs",
                format!("{clip} leaves nothing of an observation"),
            ));
        }
        // In the order in which they are listed, which a trainer may have chosen.
        let wheels: Vec<usize> = keys.get("wheel_indices", "the wheels")?;
        let has_wheels = lists
            .iter()
            .any(|list| list.iter().any(|it| it == "wheel_joint_vel"));
        let all = 0..joints.len();
        let dofs = if has_wheels {
            all.filter(|n| joints[*n].drive == Drive::Position)
                .collect()
        } else {
            all.collect()
        };
        Ok(Self {
            keys,
            joints,
            clip_after: [-clip, clip],
            dofs,
            wheels,
        })
    }

    /// Returns the terms of a list. `key` is the list's name.
    pub(super) fn plan(&self, key: &str, list: &[String]) -> Result<Vec<TermPlan>, ConfigError> {
        list.iter().map(|name| self.term(key, name)).collect()
    }

    fn term(&self, key: &str, name: &str) -> Result<TermPlan, ConfigError> {
        let source = self.source(key, name)?;
        let len = source.len(self.joints.len());
        Ok(TermPlan {
            name: name.to_owned(),
            scale: self.scale(name, len)?,
            source,
            clip_before: NO_CLIP,
            clip_after: self.clip_after,
        })
    }

    fn source(&self, key: &str, name: &str) -> Result<Source, ConfigError> {
        Ok(match name {
            "lin_vel" => Source::LinearVelocity,
            "ang_vel" => Source::AngularVelocity,
            "gravity_vec" => Source::Gravity,
            "commands" => Source::Commands,
            "dof_pos" => Source::Positions(self.dofs.clone()),
            "dof_vel" => Source::Velocities(self.dofs.clone()),
            "wheel_joint_vel" if self.wheels.is_empty() => {
                let message = "wheel_joint_vel of a robot without wheels: wheel_indices is empty";
                return Err(self.keys.complaint(key, message));
            }
            "wheel_joint_vel" => Source::Velocities(self.wheels.clone()),
            "actions" => Source::Actions,
            name if OF_MOTIONS.contains(&name) => {
                let message = format!(
                    "the term {name} follows a recorded motion, and no motion is played here"
                );
                return Err(self.keys.complaint(key, message));
            }
            name => {
                let message = format!(
                    "the term {name:?} is unknown. Known are {}",
                    KNOWN.join(", ")
                );
                return Err(self.keys.complaint(key, message));
            }
        })
    }

    fn scale(&self, name: &str, len: usize) -> Result<Vec<f32>, ConfigError> {
        let key = match name {
            "lin_vel" => "lin_vel_scale",
            "ang_vel" => "ang_vel_scale",
            "dof_pos" => "dof_pos_scale",
            "dof_vel" | "wheel_joint_vel" => "dof_vel_scale",
            "commands" => return self.command_scale(),
            _ => return Ok(vec![1.0; len]),
        };
        let scale: f32 = self
            .keys
            .get(key, &format!("the factor of the term {name}"))?;
        self.check_finite(key, scale)?;
        Ok(vec![scale; len])
    }

    fn command_scale(&self) -> Result<Vec<f32>, ConfigError> {
        let key = "commands_scale";
        let what = "three factors of the term commands: forward, left, turn";
        let scale: Vec<f32> = self.keys.get(key, what)?;
        self.keys.check_length(key, scale.len(), 3)?;
        for factor in &scale {
            self.check_finite(key, *factor)?;
        }
        Ok(scale)
    }

    fn check_finite(&self, key: &str, factor: f32) -> Result<(), ConfigError> {
        if factor.is_finite() {
            Ok(())
        } else {
            Err(self.keys.complaint(key, format!("{factor} is no factor")))
        }
    }
}
