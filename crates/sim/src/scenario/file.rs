//! The TOML of a scenario and its checks.

mod events;
mod expectations;
mod flash;
mod pc;
mod problem;
mod robot;

use std::path::Path;

use robot_plant::{
    mounting::Mounting,
    time::{self, Ps},
    world::{PlantKind, RadioKind, Start, Terrain, Variation},
};
use serde::Deserialize;
use toml::Spanned;

use super::{FlashSetup, RobotChoice, Scenario, ScenarioError};
use events::{At, read_at};
use expectations::{Expect, read_expect};
use flash::{Flash, read_flash};
pub use problem::Problem;
use robot::{Joints, Vary, read_robot, read_variation};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    seconds: Spanned<f64>,
    plant: Plant,
    #[serde(default)]
    radio: Radio,
    joints: Option<Spanned<Joints>>,
    robot: Option<Spanned<String>>,
    variation: Option<Spanned<Vary>>,
    start: Option<Spanned<Start>>,
    terrain: Option<Spanned<Terrain>>,
    #[serde(default)]
    rs00_timeout_ms: u32,
    imu_temperature_c: Option<f64>,
    mounting: Option<Spanned<String>>,
    mag_mounting: Option<Spanned<String>>,
    #[serde(default)]
    seed: u64,
    flash: Option<Spanned<Flash>>,
    #[serde(default)]
    allow_board_errors: Vec<String>,
    #[serde(default)]
    at: Vec<Spanned<At>>,
    #[serde(default)]
    expect: Vec<Spanned<Expect>>,
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Plant {
    Stand,
    Rolling,
    Free,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Radio {
    #[default]
    Sbus,
    Dbus,
}

/// Turns positions in the text into errors that name file and line.
struct Source<'a> {
    file: &'a str,
    text: &'a str,
}

impl Source<'_> {
    fn wrong(&self, offset: usize, problem: Problem) -> ScenarioError {
        let before = self.text.as_bytes().iter().take(offset);
        ScenarioError::Wrong {
            file: self.file.to_owned(),
            line: 1 + before.filter(|&&b| b == b'\n').count(),
            problem,
        }
    }
}

pub(super) fn parse(text: &str, file: &str) -> Result<Scenario, ScenarioError> {
    let source = Source { file, text };
    let raw: File = toml::from_str(text).map_err(|e| {
        let offset = e.span().map_or(0, |s| s.start);
        source.wrong(offset, Problem::Toml(e.message().to_owned()))
    })?;
    let seconds = *raw.seconds.get_ref();
    if !(seconds > 0.0 && seconds <= 3600.0) {
        let problem = Problem::Length(seconds);
        return Err(source.wrong(raw.seconds.span().start, problem));
    }
    if raw
        .imu_temperature_c
        .is_some_and(|c| !(-40.0..=85.0).contains(&c))
    {
        return Err(source.wrong(0, Problem::ImuTemperature));
    }
    let flash = match raw.flash {
        Some(flash) => {
            let offset = flash.span().start;
            let read = read_flash(flash.into_inner(), Path::new(file));
            read.map_err(|problem| source.wrong(offset, problem))?
        }
        None => FlashSetup::default(),
    };
    let mounting = read_mounting(raw.mounting, &source)?;
    let mag_mounting = read_mounting(raw.mag_mounting, &source)?.unwrap_or_default();
    let offset = raw.robot.as_ref().map_or(0, |robot| robot.span().start);
    let joints = raw.joints.as_ref().map(|joints| *joints.get_ref());
    let robot = read_robot(raw.robot.as_ref().map(|r| r.get_ref().as_str()), joints)
        .map_err(|problem| source.wrong(offset, problem))?;
    let robot_choice = match (&raw.robot, &raw.joints) {
        (Some(_), _) => RobotChoice::Named,
        (None, Some(_)) => RobotChoice::OtherJoints,
        (None, None) => RobotChoice::OfTheImage,
    };
    let variation = match &raw.variation {
        Some(vary) => read_variation(vary.get_ref())
            .map_err(|problem| source.wrong(vary.span().start, problem))?,
        None => Variation::default(),
    };
    let free = raw.plant == Plant::Free;
    let start = only_free(raw.start, "start", free, &source, is_sound_start)?;
    let terrain = only_free(raw.terrain, "terrain", free, &source, Terrain::is_sound)?;
    let mut events = Vec::new();
    for at in &raw.at {
        read_at(at.get_ref(), seconds, free, &mut events)
            .map_err(|problem| source.wrong(at.span().start, problem))?;
    }
    events.sort_by_key(|a| a.at);
    let expectations = raw
        .expect
        .into_iter()
        .map(|expect| {
            let offset = expect.span().start;
            read_expect(expect.into_inner(), seconds)
                .map_err(|problem| source.wrong(offset, problem))
        })
        .collect::<Result<_, _>>()?;
    Ok(Scenario {
        name: raw.name,
        length: time::from_seconds(seconds),
        plant: match raw.plant {
            Plant::Stand => PlantKind::Stand,
            Plant::Rolling => PlantKind::Rolling,
            Plant::Free => PlantKind::Free,
        },
        start,
        terrain,
        radio: match raw.radio {
            Radio::Sbus => RadioKind::Sbus,
            Radio::Dbus => RadioKind::Dbus,
        },
        robot,
        robot_choice,
        variation,
        rs00_timeout: u64::from(raw.rs00_timeout_ms) * time::MS,
        imu_temperature_c: raw.imu_temperature_c,
        mounting,
        mag_mounting,
        seed: raw.seed,
        flash,
        events,
        expectations,
        allow_board_errors: raw.allow_board_errors,
    })
}

/// The value of a key that only the free robot may have, if its numbers are sound.
fn only_free<T: Default>(
    raw: Option<Spanned<T>>,
    key: &'static str,
    free: bool,
    source: &Source<'_>,
    is_sound: fn(&T) -> bool,
) -> Result<T, ScenarioError> {
    match raw {
        Some(value) if !free => Err(source.wrong(value.span().start, Problem::NotFree(key))),
        Some(value) if !is_sound(value.get_ref()) => {
            Err(source.wrong(value.span().start, Problem::NoPlace(key)))
        }
        Some(value) => Ok(value.into_inner()),
        None => Ok(T::default()),
    }
}

fn is_sound_start(start: &Start) -> bool {
    match start {
        Start::Dropped { height_m } => (0.0..=10.0).contains(height_m),
        _ => true,
    }
}

fn read_mounting(
    raw: Option<Spanned<String>>,
    source: &Source<'_>,
) -> Result<Option<Mounting>, ScenarioError> {
    let Some(name) = raw else {
        return Ok(None);
    };
    let offset = name.span().start;
    let mounting = name.into_inner().parse::<Mounting>();
    mounting
        .map(Some)
        .map_err(|error| source.wrong(offset, Problem::Mounting(error.to_string())))
}

/// The instant `t`, which the key `name` gives, if it lies in the run.
fn instant(name: &'static str, t: f64, seconds: f64) -> Result<Ps, Problem> {
    if (0.0..=seconds).contains(&t) {
        Ok(time::from_seconds(t))
    } else {
        Err(Problem::OutsideRun { name, t, seconds })
    }
}

#[cfg(test)]
mod tests;
