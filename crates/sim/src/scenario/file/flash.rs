//! The key `flash`: the parameter sectors at power-on.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::Problem;
use crate::{
    machine::flash::FlashTimes,
    parameter_sectors::{MAX_VALUES, Record, SLOTS},
    scenario::{FlashContents, FlashSetup},
};

/// The parameter sectors at power-on.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Flash {
    /// Relative to the scenario's folder.
    image: Option<PathBuf>,
    /// Groups of settings that the robot has saved before.
    #[serde(default)]
    record: Vec<Stored>,
    #[serde(default)]
    times: Times,
    seed: Option<u64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    group: u8,
    #[serde(default = "one")]
    version: u8,
    /// The make of a joint's motor.
    #[serde(default)]
    variant: u8,
    values: Vec<f32>,
}

fn one() -> u8 {
    1
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Times {
    #[default]
    Typical,
    Max,
}

pub(super) fn read_flash(raw: Flash, scenario: &Path) -> Result<FlashSetup, Problem> {
    let folder = scenario.parent().unwrap_or(Path::new(""));
    let contents = match (raw.image, raw.record.is_empty()) {
        (Some(image), true) => FlashContents::Image(folder.join(image)),
        (None, true) => FlashContents::Erased,
        (None, false) => FlashContents::Records(read_records(raw.record)?),
        (Some(_), false) => {
            return Err(Problem::ImageAndRecords);
        }
    };
    Ok(FlashSetup {
        contents,
        times: match raw.times {
            Times::Typical => FlashTimes::Typical,
            Times::Max => FlashTimes::Max,
        },
        seed: raw.seed,
    })
}

fn read_records(raw: Vec<Stored>) -> Result<Vec<Record>, Problem> {
    let long = raw.iter().find(|stored| stored.values.len() > MAX_VALUES);
    if let Some(Stored { group, .. }) = long {
        return Err(Problem::TooManyValues { group: *group });
    }
    if raw.len() > SLOTS {
        return Err(Problem::TooManyRecords);
    }
    let record = |stored: Stored| Record {
        group: stored.group,
        version: stored.version,
        variant: stored.variant,
        values: stored.values,
    };
    Ok(raw.into_iter().map(record).collect())
}
