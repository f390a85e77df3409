//! Records the sensors of the disarmed robot into a table.

use std::path::Path;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use robotctl::recorder::{self, RecordTimeouts};

use crate::command::{connection::Connection, output::say};

const SECONDS: u16 = 60;
const LONGEST_S: u32 = 600;
/// A longer gap between samples is reported. This is the time of ten samples of the IMU.
const LONG_GAP_S: f64 = 0.05;

pub fn record(connection: &Connection, path: &Path, seconds: Option<u32>) -> Result<()> {
    let seconds = match seconds {
        None => SECONDS,
        Some(seconds) => match u16::try_from(seconds) {
            Ok(fits) if seconds <= LONGEST_S => fits,
            _ => bail!("the robot records at most {LONGEST_S} s of its sensors at a time"),
        },
    };
    let mut client = connection.open()?;
    let bar = ProgressBar::new(seconds.into());
    bar.set_style(ProgressStyle::with_template(
        "recording {bar:40} {pos} of {len} s",
    )?);
    let recorded = recorder::record(&mut client, seconds, RecordTimeouts::default(), |seconds| {
        bar.set_position(seconds as u64);
    });
    bar.finish_and_clear();
    let recorded = recorded?;
    std::fs::write(path, recorded.samples.table())
        .with_context(|| format!("cannot write {}", path.display()))?;
    let (imu, mag) = recorded.samples.counts();
    let seconds = recorded.samples.duration_s();
    say!(
        "recorded {seconds:.1} s: {imu} samples of accelerometer and gyro, {mag} of the magnetometer, {} lost",
        recorded.lost
    )?;
    let gap = recorded.samples.longest_gap_s();
    if gap > LONG_GAP_S {
        say!(
            "note: {gap:.2} s are missing in one place: the robot erased flash meanwhile, or was busy"
        )?;
    }
    if mag == 0 {
        say!("note: the magnetometer gave none")?;
    }
    say!("written to {}", path.display())?;
    say!("next:   robotctl calibrate accel {}", path.display())?;
    Ok(())
}
