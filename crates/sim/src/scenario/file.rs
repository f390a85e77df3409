//! The TOML of a scenario and its checks.

use std::path::{Path, PathBuf};

use robot_plant::{
    mounting::Mounting,
    time::{self, Ps},
    wire::CanFrame,
    world::{CanBusId, JointKind, PlantKind, RadioKind, RemoteInput},
};
use serde::Deserialize;
use toml::Spanned;

use super::{Action, Deed, FlashContents, FlashSetup, Scenario, ScenarioError};
use crate::machine::flash::FlashTimes;
use crate::parameter_sectors::{MAX_VALUES, Record, SLOTS};
use crate::{
    expectation::{Bound, Expectation, NamedFlag, Window},
    faults,
    signals::nearest,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    seconds: Spanned<f64>,
    plant: Plant,
    #[serde(default)]
    radio: Radio,
    #[serde(default)]
    joints: Joints,
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

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Plant {
    Stand,
    Rolling,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Radio {
    #[default]
    Sbus,
    Dbus,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Joints {
    #[default]
    Dm4310,
    Rs00,
}

/// The parameter sectors at power-on.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Flash {
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
    /// Of a joint, the make of its motor.
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct At {
    t: f64,
    remote: Option<Remote>,
    can: Option<Can>,
    fault: Option<String>,
    end_fault: Option<String>,
    duration: Option<f64>,
}

/// A frame that the PC's adapter sends.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Can {
    /// 1 or 2.
    bus: u8,
    id: u32,
    data: Vec<u8>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Remote {
    enable: Option<bool>,
    e_stop: Option<bool>,
    vx: Option<f64>,
    wz: Option<f64>,
    mode: Option<u8>,
    left_x: Option<f64>,
    left_y: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Expect {
    signal: String,
    from: Option<f64>,
    to: Option<f64>,
    at: Option<f64>,
    max_abs: Option<f64>,
    min: Option<f64>,
    max: Option<f64>,
    equals: Option<f64>,
    within: Option<[f64; 2]>,
    has_bit: Option<u8>,
    lacks_bit: Option<u8>,
    has_flag: Option<String>,
    lacks_flag: Option<String>,
    rises_above: Option<f64>,
    falls_below: Option<f64>,
    because: Option<String>,
}

/// Turns positions in the text into errors that name file and line.
struct Source<'a> {
    file: &'a str,
    text: &'a str,
}

impl Source<'_> {
    fn wrong(&self, offset: usize, what: impl Into<String>) -> ScenarioError {
        let before = self.text.as_bytes().iter().take(offset);
        ScenarioError::Wrong {
            file: self.file.to_owned(),
            line: 1 + before.filter(|&&b| b == b'\n').count(),
            what: what.into(),
        }
    }
}

pub(super) fn parse(text: &str, file: &str) -> Result<Scenario, ScenarioError> {
    let source = Source { file, text };
    let raw: File = toml::from_str(text).map_err(|e| {
        let offset = e.span().map_or(0, |s| s.start);
        source.wrong(offset, e.message())
    })?;
    let seconds = *raw.seconds.get_ref();
    if !(seconds > 0.0 && seconds <= 3600.0) {
        let what = format!("`seconds` is {seconds}; write a length between 0 and 3600");
        return Err(source.wrong(raw.seconds.span().start, what));
    }
    if raw
        .imu_temperature_c
        .is_some_and(|c| !(-40.0..=85.0).contains(&c))
    {
        let what = "`imu_temperature_c` is outside what the BMI088 works at; write -40 to 85";
        return Err(source.wrong(0, what));
    }
    let flash = match raw.flash {
        Some(flash) => {
            let offset = flash.span().start;
            let read = read_flash(flash.into_inner(), Path::new(file));
            read.map_err(|what| source.wrong(offset, what))?
        }
        None => FlashSetup::default(),
    };
    let mounting = read_mounting(raw.mounting, &source)?;
    let mag_mounting = read_mounting(raw.mag_mounting, &source)?;
    let mut actions = Vec::new();
    for at in &raw.at {
        read_at(at.get_ref(), seconds, &mut actions)
            .map_err(|what| source.wrong(at.span().start, what))?;
    }
    actions.sort_by_key(|a| a.at);
    let expectations = raw
        .expect
        .into_iter()
        .map(|expect| {
            let offset = expect.span().start;
            read_expect(expect.into_inner(), seconds).map_err(|what| source.wrong(offset, what))
        })
        .collect::<Result<_, _>>()?;
    Ok(Scenario {
        name: raw.name,
        length: time::from_seconds(seconds),
        plant: match raw.plant {
            Plant::Stand => PlantKind::Stand,
            Plant::Rolling => PlantKind::Rolling,
        },
        radio: match raw.radio {
            Radio::Sbus => RadioKind::Sbus,
            Radio::Dbus => RadioKind::Dbus,
        },
        joints: match raw.joints {
            Joints::Dm4310 => JointKind::Dm4310,
            Joints::Rs00 => JointKind::Rs00,
        },
        rs00_timeout: u64::from(raw.rs00_timeout_ms) * time::MS,
        imu_temperature_c: raw.imu_temperature_c,
        mounting,
        mag_mounting,
        seed: raw.seed,
        flash,
        actions,
        expectations,
        allow_board_errors: raw.allow_board_errors,
    })
}

fn read_mounting(
    raw: Option<Spanned<String>>,
    source: &Source<'_>,
) -> Result<Mounting, ScenarioError> {
    let Some(name) = raw else {
        return Ok(Mounting::default());
    };
    let offset = name.span().start;
    let mounting = name.into_inner().parse::<Mounting>();
    mounting.map_err(|error| source.wrong(offset, error.to_string()))
}

fn read_flash(raw: Flash, scenario: &Path) -> Result<FlashSetup, String> {
    let folder = scenario.parent().unwrap_or(Path::new(""));
    let contents = match (raw.image, raw.record.is_empty()) {
        (Some(image), true) => FlashContents::Image(folder.join(image)),
        (None, true) => FlashContents::Erased,
        (None, false) => FlashContents::Records(read_records(raw.record)?),
        (Some(_), false) => {
            return Err("flash has either an `image` or records; leave one of them out".into());
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

fn read_records(raw: Vec<Stored>) -> Result<Vec<Record>, String> {
    let long = raw.iter().find(|stored| stored.values.len() > MAX_VALUES);
    if let Some(Stored { group, .. }) = long {
        return Err(format!(
            "the record of group {group} has more than {MAX_VALUES} values"
        ));
    }
    if raw.len() > SLOTS {
        return Err(format!("a sector holds {SLOTS} records"));
    }
    let record = |stored: Stored| Record {
        group: stored.group,
        version: stored.version,
        variant: stored.variant,
        values: stored.values,
    };
    Ok(raw.into_iter().map(record).collect())
}

fn instant(name: &str, t: f64, seconds: f64) -> Result<Ps, String> {
    if (0.0..=seconds).contains(&t) {
        Ok(time::from_seconds(t))
    } else {
        Err(format!(
            "`{name}` is {t} s, outside the run; write a time from 0 to {seconds} or raise `seconds`"
        ))
    }
}

fn read_at(at: &At, seconds: f64, actions: &mut Vec<Action>) -> Result<(), String> {
    let start = instant("t", at.t, seconds)?;
    if at.remote.is_none() && at.can.is_none() && at.fault.is_none() && at.end_fault.is_none() {
        return Err(
            "this [[at]] does nothing; add `remote`, `can`, `fault` or `end_fault`, or remove it"
                .into(),
        );
    }
    if let Some(remote) = &at.remote {
        actions.push(Action {
            at: start,
            what: Deed::Remote(read_remote(remote)?),
        });
    }
    if let Some(can) = &at.can {
        let (bus, frame) = read_can(can)?;
        actions.push(Action {
            at: start,
            what: Deed::Can(bus, frame),
        });
    }
    if let Some(name) = &at.fault {
        actions.push(Action {
            at: start,
            what: Deed::StartFault(known_fault(name)?),
        });
    }
    if let Some(name) = &at.end_fault {
        actions.push(Action {
            at: start,
            what: Deed::EndFault(known_fault(name)?),
        });
    }
    match (&at.fault, at.duration) {
        (Some(name), Some(duration)) if duration > 0.0 => actions.push(Action {
            at: instant("t + duration", at.t + duration, seconds)?,
            what: Deed::EndFault(name.clone()),
        }),
        (_, None) => {}
        (None, Some(_)) => return Err("`duration` belongs to a `fault`; name the fault".into()),
        (_, Some(duration)) => {
            return Err(format!("`duration` is {duration}; write seconds above 0"));
        }
    }
    Ok(())
}

fn read_remote(remote: &Remote) -> Result<RemoteInput, String> {
    for (name, value) in [
        ("vx", remote.vx),
        ("wz", remote.wz),
        ("left_x", remote.left_x),
        ("left_y", remote.left_y),
    ] {
        if value.is_some_and(|v| !(-1.0..=1.0).contains(&v)) {
            return Err(format!("`{name}` is a stick: write −1 to 1"));
        }
    }
    if remote.mode.is_some_and(|m| m > 2) {
        return Err("`mode` is a three-position switch: write 0, 1 or 2".into());
    }
    Ok(RemoteInput {
        enable: remote.enable,
        e_stop: remote.e_stop,
        vx: remote.vx,
        wz: remote.wz,
        mode: remote.mode,
        left_x: remote.left_x,
        left_y: remote.left_y,
    })
}

fn read_can(can: &Can) -> Result<(CanBusId, CanFrame), String> {
    let bus = match can.bus {
        1 => CanBusId::Can1,
        2 => CanBusId::Can2,
        other => return Err(format!("`bus` is {other}; the board has 1 and 2")),
    };
    if can.id > 0x7FF {
        let id = can.id;
        return Err(format!(
            "`id` is {id:#x}; a standard identifier ends at 0x7FF"
        ));
    }
    let mut data = [0; 8];
    let Some(bytes) = data.get_mut(..can.data.len()) else {
        return Err("`data` is longer than the 8 bytes of a frame".into());
    };
    bytes.copy_from_slice(&can.data);
    let frame = CanFrame {
        id: can.id,
        extended: false,
        remote: false,
        dlc: can.data.len() as u8,
        data,
    };
    Ok((bus, frame))
}

fn known_fault(name: &str) -> Result<String, String> {
    if faults::all().any(|f| f.name == name) {
        return Ok(name.to_owned());
    }
    let hint = nearest(name, faults::all().map(|f| f.name))
        .map_or(String::new(), |n| format!(" did you mean `{n}`?"));
    Err(format!(
        "no fault is named `{name}`;{hint} `cargo xtask sim --list-faults` lists them"
    ))
}

fn read_expect(raw: Expect, seconds: f64) -> Result<Expectation, String> {
    let window = match (raw.from, raw.to, raw.at) {
        (Some(from), Some(to), None) => {
            let (start, end) = (instant("from", from, seconds)?, instant("to", to, seconds)?);
            if end < start {
                return Err(format!("`from` {from} comes after `to` {to}; swap them"));
            }
            Window { start, end }
        }
        (None, None, Some(at)) => Window::instant(instant("at", at, seconds)?),
        _ => return Err("write either `from` and `to`, or `at`".into()),
    };
    let bounds: Vec<Bound> = [
        raw.max_abs.map(Bound::MaxAbs),
        raw.min.map(Bound::Min),
        raw.max.map(Bound::Max),
        raw.equals.map(Bound::Equals),
        raw.within
            .map(|[value, tolerance]| Bound::Within { value, tolerance }),
        raw.has_bit.map(Bound::HasBit),
        raw.lacks_bit.map(Bound::LacksBit),
        raw.rises_above.map(Bound::RisesAbove),
        raw.falls_below.map(Bound::FallsBelow),
    ]
    .into_iter()
    .flatten()
    .collect();
    let named = |name: Option<String>, set| name.map(|name| NamedFlag { name, set });
    let flags: Vec<NamedFlag> = [named(raw.has_flag, true), named(raw.lacks_flag, false)]
        .into_iter()
        .flatten()
        .collect();
    if bounds.is_empty() && flags.is_empty() {
        return Err("nothing is expected of the signal; add one of `max_abs`, `min`, `max`, `equals`, `within = [value, tolerance]`, `has_flag`, `lacks_flag`, `has_bit`, `lacks_bit`, `rises_above`, `falls_below`".into());
    }
    if bounds.iter().any(|b| !b.is_usable()) {
        return Err("a bound is not finite, a tolerance is negative or a bit is above 31; write plain numbers".into());
    }
    Ok(Expectation {
        signal: raw.signal,
        window,
        bounds,
        flags,
        because: raw.because,
    })
}

#[cfg(test)]
mod tests;
