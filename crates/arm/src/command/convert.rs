//! One calibration format to the other.

use std::path::PathBuf;

use anyhow::Result;
use robot_arm::calibration::{Calibration, Format};

use super::output::say;

#[derive(clap::Args)]
#[command(
    after_help = "The servos need the offsets of the new file then: armctl calibrate --apply NEW.

Example:
  armctl convert so101_follower.json --format plain --out left_arm.json"
)]
pub struct Convert {
    /// Calibration file of either format
    file: PathBuf,
    /// plain (id, homing_offset, range_min, range_max) or lerobot
    #[arg(long, value_name = "plain|lerobot", value_parser = format)]
    format: Format,
    /// File to write
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Takes the name of a format.
pub fn format(text: &str) -> Result<Format, String> {
    match text {
        "plain" => Ok(Format::Plain),
        "lerobot" => Ok(Format::LeRobot),
        _ => Err(format!("{text}: a format is plain or lerobot")),
    }
}

impl Convert {
    pub fn run(self) -> Result<()> {
        let converted = Calibration::load(&self.file)?.to_format(self.format)?;
        converted.save(&self.out)?;
        say!("wrote {}", self.out.display())?;
        Ok(())
    }
}
