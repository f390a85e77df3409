//! `robotctl record`: records the sensors' samples into a table.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use robotctl::recorder::{self, RecordTimeouts};

use super::{connection::Connection, output::say};

/// A longer gap between samples is reported. This is the time of ten samples of the IMU.
const LONG_GAP_S: f64 = 0.05;

#[derive(clap::Args)]
pub struct Record {
    #[command(flatten)]
    connection: Connection,
    /// Table (CSV) to write, which `robotctl calibrate` reads
    file: PathBuf,
    /// Length of the recording in s; the robot must be disarmed and its enable switch off
    #[arg(long, value_name = "S", default_value_t = 60, value_parser = clap::value_parser!(u16).range(1..=600))]
    seconds: u16,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

impl Record {
    pub fn run(self) -> Result<()> {
        ensure!(
            self.force || !self.file.exists(),
            "{} exists: name another file, or add --force",
            self.file.display()
        );
        let mut client = self.connection.open()?;
        let bar = ProgressBar::new(self.seconds.into());
        bar.set_style(ProgressStyle::with_template(
            "recording {bar:40} {pos} of {len} s",
        )?);
        let recorded = recorder::record(
            &mut client,
            self.seconds,
            RecordTimeouts::default(),
            |seconds| bar.set_position(seconds as u64),
        );
        bar.finish_and_clear();
        let recorded = recorded?;
        std::fs::write(&self.file, recorded.samples.table())
            .with_context(|| format!("cannot write {}", self.file.display()))?;
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
        say!("written to {}", self.file.display())?;
        say!("next:   robotctl calibrate accel {}", self.file.display())?;
        Ok(())
    }
}
