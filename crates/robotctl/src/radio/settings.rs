//! Converts the controls that were found into settings of the robot, and writes them.

use robot_app::domain::{NO_CHANNEL, RemoteChannel};

use super::{Control, Movement, ends};
use crate::{
    parameter_file::ParameterFile,
    settings::{self, Setting, UnknownName},
    tuning::{self, ApplyError, TuningClient, TuningError},
};

/// Setting for the channel of the enable switch. Without this channel the robot cannot be armed.
pub const ENABLE_CHANNEL: &str = "radio.enable-channel";

/// A control and its channel, which is `None` if the transmitter has no such control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MappedControl {
    pub control: Control,
    pub channel: Option<RemoteChannel>,
}

impl MappedControl {
    pub fn switch(moved: &Movement) -> Self {
        Self {
            control: moved.control,
            channel: Some(ends::switch(moved)),
        }
    }

    pub(super) fn has(&self, index: usize) -> bool {
        let channel = self.channel;
        channel.is_some_and(|channel| channel.index as usize == index)
    }

    /// Returns the full names of settings and their values. A control without a channel keeps its ends.
    pub fn settings(&self) -> Vec<(String, f32)> {
        let name = self.control.name();
        let index = self.channel.map_or(NO_CHANNEL, |channel| channel.index);
        let mut settings = vec![(format!("radio.{name}-channel"), index)];
        if let Some(channel) = self.channel {
            settings.extend([
                (format!("radio.{name}-reversed"), channel.reversed),
                (format!("radio-travel.{name}-low"), channel.low),
                (format!("radio-travel.{name}-centre"), channel.centre),
                (format!("radio-travel.{name}-high"), channel.high),
            ]);
        }
        // Whole numbers up to 2047 are exact.
        let exact = settings.into_iter();
        exact.map(|(name, value)| (name, value as f32)).collect()
    }

    /// Returns words such as `drive: channel 1, 172 … 992 … 1811; forward is the high count`.
    pub fn in_words(&self) -> String {
        let name = self.control.name();
        let Some(channel) = self.channel else {
            return format!("{name}: none");
        };
        let RemoteChannel {
            index,
            low,
            centre,
            high,
            reversed,
        } = channel;
        let (end, count) = (
            self.control.high_end(),
            ["high", "low"][usize::from(reversed == 1)],
        );
        format!("{name}: channel {index}, {low} … {centre} … {high}; {end} is the {count} count")
    }
}

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
