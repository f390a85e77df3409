//! Converts the controls that were found into settings of the robot, and writes them.

use robot_app::domain::NO_CHANNEL;

use super::MappedControl;
use crate::{
    parameter_file::ParameterFile,
    settings::{self, Setting, UnknownName},
    tuning::{self, ApplyError, TuningClient, TuningError},
};

/// Setting for the channel of the enable switch. Without this channel the robot cannot be armed.
pub const ENABLE_CHANNEL: &str = "radio.enable-channel";

/// Returns the settings that differ: the setting, the robot's value, and the value that was found. The robot's enable
/// channel was `enable_was` before this tool removed it.
pub fn differing(
    client: &mut TuningClient,
    found: &[MappedControl],
    enable_was: f32,
) -> Result<Vec<(Setting, f32, f32)>, WriteError> {
    let mut differing = Vec::new();
    for (name, wanted) in found.iter().flat_map(MappedControl::settings) {
        let named = settings::find(&name)?;
        let is = match name.as_str() {
            ENABLE_CHANNEL => enable_was,
            _ => client.read(named)?,
        };
        if is != wanted {
            differing.push((named, is, wanted));
        }
    }
    Ok(differing)
}

#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    #[error(transparent)]
    Name(#[from] UnknownName),
    #[error(transparent)]
    Tuning(#[from] TuningError),
    #[error("the robot has no enable channel now, so that it cannot be armed: repeat the command")]
    Unfinished { source: ApplyError },
    #[error("the robot has no enable channel now, so that it cannot be armed: repeat the command")]
    NotEnabled { source: TuningError },
}

/// Writes the settings that differ. The robot has no enable switch while its channels change, because it could read
/// half a mapping as enabled. That would not be safe, and it would refuse further settings. An interruption leaves a
/// robot that cannot be armed.
pub fn write(client: &mut TuningClient, found: &[MappedControl]) -> Result<(), WriteError> {
    let enable = settings::find(ENABLE_CHANNEL)?;
    let mut enable_index = client.read(enable)?;
    let mut file = ParameterFile::default();
    for (name, value) in found.iter().flat_map(MappedControl::settings) {
        if name == ENABLE_CHANNEL {
            enable_index = value;
        } else {
            file.set(&name, value);
        }
    }
    client.write(enable, NO_CHANNEL as f32)?;
    tuning::apply(client, &file).map_err(|source| WriteError::Unfinished { source })?;
    let enabled = client.write(enable, enable_index);
    enabled.map_err(|source| WriteError::NotEnabled { source })
}
