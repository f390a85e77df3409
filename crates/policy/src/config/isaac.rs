//! What exports of Isaac Lab have in common: names of terms, histories, and joints that a robot's `base.yaml` completes.

use super::{
    ConfigError,
    base::{Base, BaseJoint},
};
use crate::{
    ActionPlan, Drive, Group, HistoryOrder, Joint, JointMapping, PolicyDescription, Source,
    TermPlan,
};

pub(super) const UNLIMITED: [f32; 2] = [f32::MIN, f32::MAX];

/// A joint of the export, in the order of the actions.
pub(super) struct ExportedJoint<'a> {
    /// The joint of `base.yaml`.
    pub(super) base: &'a BaseJoint,
    pub(super) default_rad: f32,
    pub(super) kp: f32,
    pub(super) kd: f32,
    pub(super) action: ActionPlan,
}

impl ExportedJoint<'_> {
    pub(super) fn joint(&self) -> Joint {
        Joint {
            name: self.base.name.clone(),
            drive: self.base.drive,
            default_rad: self.default_rad,
            kp: self.kp,
            kd: self.kd,
            fixed_kp: self.base.fixed_kp,
            fixed_kd: self.base.fixed_kd,
            torque_limit_nm: self.base.torque_limit_nm,
            action: self.action,
        }
    }
}

/// A term of the export.
pub(super) struct ExportedTerm<'a> {
    pub(super) name: &'a str,
    /// Joints of the term, by their places in the export. `None` are all.
    pub(super) joints: Option<Vec<usize>>,
    /// Factors, or `None` for 1.
    pub(super) scale: Option<Vec<f32>>,
    pub(super) clip: [f32; 2],
    /// Frames, 0 and 1 for that of now.
    pub(super) history: usize,
}

/// An export with what it is completed by.
pub(super) struct Export<'a> {
    pub(super) file: &'a str,
    pub(super) joints: Vec<ExportedJoint<'a>>,
    /// Place in `joints` of each joint of the export.
    pub(super) places: Vec<usize>,
}

impl Export<'_> {
    /// Returns the description.
    pub(super) fn describe(
        &self,
        base: &Base,
        [name, model_file]: [&str; 2],
        decimation: u32,
        terms: &[ExportedTerm<'_>],
        command_ranges: [[f32; 2]; 3],
    ) -> Result<PolicyDescription, ConfigError> {
        let motors = self.joints.iter().map(|joint| joint.base.motor);
        let directions: Vec<i8> = self.joints.iter().map(|it| it.base.direction).collect();
        let mapping = JointMapping::new(motors.collect(), &directions).map_err(|error| {
            self.complaint(&format!(
                "its joints are not those of {}: {error}",
                base.file
            ))
        })?;
        self.check_stiffness()?;
        let observation = terms.iter().map(|term| self.group(term));
        Ok(PolicyDescription {
            name: name.to_owned(),
            model_file: model_file.to_owned(),
            control_period_s: base.control_period_s,
            decimation,
            joints: self.joints.iter().map(ExportedJoint::joint).collect(),
            mapping,
            observation: observation.collect::<Result<_, _>>()?,
            command_ranges,
        })
    }

    fn check_stiffness(&self) -> Result<(), ConfigError> {
        let mut joints = self.joints.iter();
        let stiff = joints.find(|joint| joint.base.drive == Drive::Speed && joint.kp != 0.0);
        stiff.map_or(Ok(()), |joint| {
            Err(self.complaint(&format!(
                "{} is a wheel with a stiffness of {}: a wheel has no angle to hold, so it is 0",
                joint.base.name, joint.kp
            )))
        })
    }

    /// Each term has a history of its own, its oldest frame first.
    fn group(&self, term: &ExportedTerm<'_>) -> Result<Group, ConfigError> {
        let source = self.source(term)?;
        let len = source.len(self.joints.len());
        let scale = term.scale.clone().unwrap_or_else(|| vec![1.0; len]);
        if scale.len() != len {
            return Err(self.complaint(&format!(
                "the term {} has {len} values, and its scale {}",
                term.name,
                scale.len()
            )));
        }
        Ok(Group {
            terms: vec![TermPlan {
                name: term.name.to_owned(),
                source,
                scale,
                clip_before: term.clip,
                clip_after: UNLIMITED,
            }],
            ages: (0..term.history.max(1)).rev().collect(),
            order: HistoryOrder::Time,
        })
    }

    fn source(&self, term: &ExportedTerm<'_>) -> Result<Source, ConfigError> {
        Ok(match term.name {
            "base_lin_vel" => Source::LinearVelocity,
            "base_ang_vel" => Source::AngularVelocity,
            "projected_gravity" => Source::Gravity,
            "velocity_commands" | "command" => Source::Commands,
            "joint_pos" | "joint_pos_rel" => Source::Positions(self.without_wheels(term)?),
            "joint_pos_rel_without_wheel" => Source::Positions(self.joints_of(term)?),
            "joint_vel" | "joint_vel_rel" => Source::Velocities(self.joints_of(term)?),
            "actions" | "last_action" => Source::Actions,
            name => {
                return Err(self.complaint(&format!(
                    "the term {name} is unknown. Known are base_lin_vel, base_ang_vel, projected_gravity, velocity_commands, \
                     joint_pos_rel, joint_pos_rel_without_wheel, joint_vel_rel, last_action. Terms of motions and of gaits are \
                     not played here"
                )));
            }
        })
    }

    fn joints_of(&self, term: &ExportedTerm<'_>) -> Result<Vec<usize>, ConfigError> {
        let all = || (0..self.places.len()).collect();
        let indices: Vec<usize> = term.joints.clone().unwrap_or_else(all);
        let joints = indices.iter().map(|index| {
            let place = self.places.get(*index).copied();
            place.ok_or_else(|| {
                let message = format!(
                    "the term {} has a joint {index}, and there are {}",
                    term.name,
                    self.places.len()
                );
                self.complaint(&message)
            })
        });
        joints.collect()
    }

    fn without_wheels(&self, term: &ExportedTerm<'_>) -> Result<Vec<usize>, ConfigError> {
        let joints = self.joints_of(term)?;
        let mut wheels = joints.iter().map(|place| self.joints[*place].base);
        match wheels.find(|base| base.drive == Drive::Speed) {
            None => Ok(joints),
            Some(base) => Err(self.complaint(&format!(
                "the term {} has the angle of {}, a wheel: it grows for ever in a simulator and wraps on the robot. Train with \
                 joint_pos_rel_without_wheel, or with the other joints only",
                term.name, base.name
            ))),
        }
    }

    fn complaint(&self, message: &str) -> ConfigError {
        ConfigError::Malformed {
            file: self.file.to_owned(),
            message: message.to_owned(),
        }
    }
}
