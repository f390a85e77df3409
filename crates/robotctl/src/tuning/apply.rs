//! Writes a parameter file to the robot.

use robot_app::{
    domain::NO_CHANNEL,
    tuning::{Parameter, ParameterKind},
};

use super::{TuningClient, TuningError};
use crate::{
    parameter_file::ParameterFile,
    settings::{Setting, UnknownName, find},
};

const MOUNTING: &str = "mounting";

/// A setting of the file.
#[derive(Clone, Copy, Debug)]
pub struct Applied {
    pub named: Setting,
    pub before: f32,
    pub after: f32,
}

#[derive(Debug, thiserror::Error)]
pub enum ApplyError {
    #[error(transparent)]
    Name(#[from] UnknownName),
    #[error("{name} = {value} is not allowed: {allowed}; nothing was written")]
    Range {
        name: String,
        value: String,
        allowed: String,
    },
    #[error("nothing was written")]
    Unwritten { source: TuningError },
    #[error("{written} of {all} settings were written; mend the cause and repeat the command")]
    Partly {
        source: TuningError,
        written: usize,
        all: usize,
    },
}

/// Writes what differs from the robot's present values. Unknown names and values out of range are found before anything
/// is written.
pub fn apply(client: &mut TuningClient, file: &ParameterFile) -> Result<Vec<Applied>, ApplyError> {
    let wanted: Vec<(Setting, f32)> = file
        .iter()
        .map(|(name, value)| Ok((checked(find(name)?, value)?, value)))
        .collect::<Result<_, ApplyError>>()?;
    let mut settings = Vec::new();
    for (named, after) in wanted {
        let before = client
            .read(named)
            .map_err(|source| ApplyError::Unwritten { source })?;
        settings.push(Applied {
            named,
            before,
            after,
        });
    }
    let mut written = 0;
    write_all(client, &settings, &mut written).map_err(|source| match written {
        0 => ApplyError::Unwritten { source },
        _ => ApplyError::Partly {
            source,
            written,
            all: settings.len(),
        },
    })?;
    Ok(settings)
}

fn checked(named: Setting, value: f32) -> Result<Setting, ApplyError> {
    if may_be(named.parameter, value) {
        return Ok(named);
    }
    Err(ApplyError::Range {
        name: named.full_name(),
        value: named.in_words(value),
        allowed: named.allowed(),
    })
}

fn may_be(parameter: &Parameter, value: f32) -> bool {
    let of_kind = match parameter.kind {
        ParameterKind::Float => true,
        ParameterKind::Integer | ParameterKind::Choice(_) => value.fract() == 0.0,
        ParameterKind::Sign => value.abs() == 1.0,
    };
    of_kind && (parameter.min..=parameter.max).contains(&value)
}

/// Radio channels that were taken from their function, so that another one can have them.
#[derive(Default)]
struct FreedChannels(Vec<u8>);

impl FreedChannels {
    /// True for a radio channel that has not been freed yet. From now on it counts as freed.
    fn take(&mut self, setting: &Applied) -> bool {
        let Setting { group, parameter } = setting.named;
        let is_channel = group.name == "radio" && parameter.name.ends_with("-channel");
        let is_new = is_channel && !self.0.contains(&parameter.index);
        if is_new {
            self.0.push(parameter.index);
        }
        is_new
    }
}

/// Writes the values in an order that the robot accepts. The mounting of the sensors comes before their calibrations,
/// which depend on it. A value that is refused because of the others is written after them.
fn write_all(
    client: &mut TuningClient,
    settings: &[Applied],
    written: &mut usize,
) -> Result<(), TuningError> {
    let mut freed = FreedChannels::default();
    let mut waiting: Vec<&Applied> = settings.iter().filter(|s| s.before != s.after).collect();
    waiting.sort_by_key(|setting| setting.named.group.name != MOUNTING);
    while !waiting.is_empty() {
        let mut refused = Vec::new();
        let mut last_error = None;
        let tried = waiting.len();
        for setting in waiting {
            match client.write(setting.named, setting.after) {
                Ok(()) => *written += 1,
                Err(error) if error.is_inconsistent() => {
                    refused.push(setting);
                    last_error = Some(error);
                }
                Err(error) => return Err(error),
            }
        }
        if let (true, Some(error)) = (refused.len() == tried, last_error) {
            // Functions that exchange their channels wait for each other in a ring.
            let Some(channel) = refused.iter().find(|setting| freed.take(setting)) else {
                return Err(error);
            };
            client.write(channel.named, NO_CHANNEL as f32)?;
        }
        waiting = refused;
    }
    Ok(())
}
