//! Keys of YAML files with the places where they were found.

use std::{collections::BTreeMap, fs, path::Path};

use serde::de::DeserializeOwned;
use serde_json::Value;
use serde_saphyr::Spanned;

use super::ConfigError;

/// Keys of rl_sar's files, and four of our own behind them.
pub(super) const KNOWN: [&str; 31] = [
    "dt",
    "decimation",
    "num_of_dofs",
    "joint_names",
    "joint_controller_names",
    "joint_mapping",
    "wheel_indices",
    "default_dof_pos",
    "torque_limits",
    "fixed_kp",
    "fixed_kd",
    "rl_kp",
    "rl_kd",
    "model_name",
    "num_observations",
    "observations",
    "observations_history",
    "observations_history_priority",
    "clip_obs",
    "clip_actions_lower",
    "clip_actions_upper",
    "action_scale",
    "lin_vel_scale",
    "ang_vel_scale",
    "dof_pos_scale",
    "dof_vel_scale",
    "commands_scale",
    "observations_nonstack",
    "joint_directions",
    "commands_lower",
    "commands_upper",
];

/// Keys of rl_sar's policies that follow a motion.
const OF_MOTIONS: [&str; 2] = ["motion_file", "waist_joint_indices"];

/// A value and the place where it stands.
#[derive(Clone, Debug)]
struct Entry {
    value: Value,
    file: String,
    line: u64,
}

/// Keys of a file, or of files of which each overrides those before it, key by key.
#[derive(Clone, Debug, Default)]
pub(super) struct Keys {
    entries: BTreeMap<String, Entry>,
    files: Vec<String>,
}

type Document = BTreeMap<String, Spanned<Value>>;

impl Keys {
    /// Adds the keys below `top`, the only key at the top of a file.
    pub(super) fn read_below(mut self, file: &Path, top: &str) -> Result<Self, ConfigError> {
        let documents: BTreeMap<String, Document> = parse(file)?;
        let name = file.display().to_string();
        let found: Vec<&str> = documents.keys().map(String::as_str).collect();
        if found != [top] {
            let message = format!(
                "the key at its top is {found:?}, and by its folder it has to be \"{top}\": rename one of them"
            );
            return Err(ConfigError::Malformed {
                file: name,
                message,
            });
        }
        let entries = documents.into_values().flatten();
        self.entries.extend(entries.map(|(key, spanned)| {
            let entry = Entry {
                line: spanned.referenced.line(),
                value: spanned.value,
                file: name.clone(),
            };
            (key, entry)
        }));
        self.files.push(name);
        Ok(self)
    }

    /// Refuses keys that nobody knows.
    pub(super) fn know_only(&self, known: &[&str]) -> Result<(), ConfigError> {
        let mut entries = self.entries.keys();
        match entries.find(|key| !known.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) if OF_MOTIONS.contains(&key.as_str()) => {
                let message = "the policy follows a recorded motion, and no motion is played here";
                Err(self.complaint(key, message))
            }
            Some(key) => {
                let message = format!(
                    "this key is unknown. Known are {}. Is it misspelt? Else take it out",
                    known.join(", ")
                );
                Err(self.complaint(key, message))
            }
        }
    }

    /// Returns the names of the files.
    pub(super) fn files(&self) -> String {
        self.files.join(", ")
    }

    /// Returns the value of a key that must be there. `what` says what it is.
    pub(super) fn get<T: DeserializeOwned>(&self, key: &str, what: &str) -> Result<T, ConfigError> {
        self.find(key, what)?.ok_or_else(|| ConfigError::Missing {
            files: self.files.join(", "),
            key: key.to_owned(),
            message: what.to_owned(),
        })
    }

    /// Returns the value of a key, if it is there.
    pub(super) fn find<T: DeserializeOwned>(
        &self,
        key: &str,
        what: &str,
    ) -> Result<Option<T>, ConfigError> {
        let Some(entry) = self.entries.get(key) else {
            return Ok(None);
        };
        T::deserialize(&entry.value)
            .map(Some)
            .map_err(|error| self.complaint(key, format!("{error}. It is {what}")))
    }

    /// Returns a list that has a value for each joint.
    pub(super) fn per_joint<T: DeserializeOwned>(
        &self,
        key: &str,
        what: &str,
        joints: usize,
    ) -> Result<Vec<T>, ConfigError> {
        let list: Vec<T> = self.get(key, what)?;
        self.check_length(key, list.len(), joints)?;
        Ok(list)
    }

    /// Refuses a list of another length.
    pub(super) fn check_length(
        &self,
        key: &str,
        found: usize,
        wanted: usize,
    ) -> Result<(), ConfigError> {
        if found == wanted {
            Ok(())
        } else {
            Err(self.complaint(key, format!("{found} values, and it has to have {wanted}")))
        }
    }

    /// Returns a complaint about a key that is there.
    pub(super) fn complaint(&self, key: &str, message: impl Into<String>) -> ConfigError {
        let place = self.entries.get(key);
        ConfigError::Key {
            file: place.map_or_else(|| self.files.join(", "), |entry| entry.file.clone()),
            line: place.map_or(0, |entry| entry.line),
            key: key.to_owned(),
            message: message.into(),
        }
    }
}

pub(super) fn parse<T: DeserializeOwned>(file: &Path) -> Result<T, ConfigError> {
    let name = file.display().to_string();
    let text = fs::read_to_string(file).map_err(|error| ConfigError::Unreadable {
        file: name.clone(),
        error,
    })?;
    serde_saphyr::from_str(&text).map_err(|error| ConfigError::Malformed {
        file: name,
        message: error.without_snippet().to_string(),
    })
}
