//! Metadata of an ONNX file, as whole_body_tracking and its relatives write them: lists with commas between the values. A
//! robot's `base.yaml` says what they do not: motors, limits, wheels, periods.

use std::{collections::BTreeMap, path::Path, str::FromStr};

use super::{
    ConfigError,
    base::Base,
    isaac::{Export, ExportedJoint, ExportedTerm, UNLIMITED},
};
use crate::{ActionPlan, Drive, PolicyDescription};

/// Reads the metadata of `file`, the network of a policy called `name`.
pub(super) fn read(
    policies: &Path,
    robot: &str,
    name: &str,
    file: &Path,
    metadata: &BTreeMap<String, String>,
) -> Result<PolicyDescription, ConfigError> {
    let base = Base::read(policies, robot)?;
    let shown = file.display().to_string();
    let lists = Lists {
        file: &shown,
        metadata,
    };
    let terms = lists.terms()?;
    let joints = lists.joints(&base)?;
    let export = Export {
        file: &shown,
        places: (0..joints.len()).collect(),
        joints,
    };
    let model_file = file
        .file_name()
        .map_or_else(String::new, |it| it.to_string_lossy().into_owned());
    export.describe(
        &base,
        [name, &model_file],
        base.decimation,
        &terms,
        [UNLIMITED; 3],
    )
}

/// Metadata, and the file that they are from.
struct Lists<'a> {
    file: &'a str,
    metadata: &'a BTreeMap<String, String>,
}

impl<'a> Lists<'a> {
    fn complaint(&self, message: impl Into<String>) -> ConfigError {
        ConfigError::Malformed {
            file: self.file.to_owned(),
            message: format!("metadata: {}", message.into()),
        }
    }

    fn words(&self, key: &str) -> Result<Vec<&'a str>, ConfigError> {
        let text = self.metadata.get(key).ok_or_else(|| {
            self.complaint(format!(
                "{key} is missing. Without config.yaml and deploy.yaml they describe the policy"
            ))
        })?;
        Ok(text
            .split(',')
            .map(str::trim)
            .filter(|it| !it.is_empty())
            .collect())
    }

    fn numbers<T: FromStr>(&self, key: &str, wanted: usize) -> Result<Vec<T>, ConfigError> {
        let words = self.words(key)?;
        if words.len() != wanted {
            let message = format!("{key}: {} values, and it has to have {wanted}", words.len());
            return Err(self.complaint(message));
        }
        let numbers = words.into_iter().map(|word| {
            let number = word.parse();
            number.map_err(|_| self.complaint(format!("{key}: {word:?} is no number")))
        });
        numbers.collect()
    }

    fn joints<'b>(&self, base: &'b Base) -> Result<Vec<ExportedJoint<'b>>, ConfigError> {
        let names = self.words("joint_names")?;
        let numbers = |key| self.numbers::<f32>(key, names.len());
        let default_rad = numbers("default_joint_pos")?;
        let kp = numbers("joint_stiffness")?;
        let kd = numbers("joint_damping")?;
        let scale = numbers("action_scale")?;
        let joints = names.iter().enumerate().map(|(n, name)| {
            let joint = base.named(name).ok_or_else(|| {
                self.complaint(format!("joint_names: {} knows no {name}", base.file))
            })?;
            Ok(ExportedJoint {
                base: joint,
                default_rad: default_rad[n],
                kp: kp[n],
                kd: kd[n],
                action: ActionPlan {
                    clip: UNLIMITED,
                    scale: scale[n],
                    offset: match joint.drive {
                        Drive::Position => default_rad[n],
                        Drive::Speed => 0.0,
                    },
                    target_range: UNLIMITED,
                },
            })
        });
        joints.collect()
    }

    fn terms(&self) -> Result<Vec<ExportedTerm<'a>>, ConfigError> {
        let names = self.words("observation_names")?;
        let history: Vec<usize> = self.numbers("observation_history_lengths", names.len())?;
        if names.contains(&"command") {
            self.check_commands()?;
        }
        let terms = names
            .into_iter()
            .zip(history)
            .map(|(name, history)| ExportedTerm {
                name,
                joints: None,
                scale: None,
                clip: UNLIMITED,
                history,
            });
        Ok(terms.collect())
    }

    /// The term `command` is that of the only command. That of a motion has other values.
    fn check_commands(&self) -> Result<(), ConfigError> {
        match self.words("command_names")?.as_slice() {
            ["base_velocity" | "twist" | "velocity"] => Ok(()),
            names => Err(self.complaint(format!(
                "command_names: {names:?} is not a velocity: the term command follows a recorded motion, and no motion is \
                 played here"
            ))),
        }
    }
}
