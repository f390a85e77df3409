//! Records homes and ranges of all joints.

mod session;

use std::path::PathBuf;

use anyhow::{Result, bail, ensure};
use robot_arm::calibration::{Calibration, Format};

use super::{connection::Arm, convert::format, output::say, stop::Stop};
use session::Session;

#[derive(clap::Args)]
#[command(
    after_help = "The torque goes off: hold the arm. Put every joint into the middle of its travel, press Enter, move each to \
both of its stops, press Enter. --arm says which joints there are; without it they are those of an SO-101. Nothing is stored \
before the end.

Examples:
  armctl calibrate --port /dev/ttyACM0 --out left_arm.json
  armctl calibrate --port /dev/ttyACM0 --out so101.json --format lerobot
  armctl calibrate --port /dev/ttyACM0 --apply so101.json    stores a file's values in the servos"
)]
pub struct Calibrate {
    #[command(flatten)]
    arm: Arm,
    /// File to write
    #[arg(long, value_name = "FILE", required_unless_present = "apply")]
    out: Option<PathBuf>,
    /// plain (left_arm.json) or lerobot, whose offset in the servo moves the seam out of the travel
    #[arg(long, value_name = "plain|lerobot", default_value = "plain", value_parser = format)]
    format: Format,
    /// Joints without stops
    #[arg(long, value_name = "JOINT", default_value = "wrist_roll")]
    whole_turn: Vec<String>,
    /// Only store the values of this file in the servos
    #[arg(long, value_name = "FILE", conflicts_with = "out")]
    apply: Option<PathBuf>,
}

impl Calibrate {
    pub fn run(self) -> Result<()> {
        let stop = Stop::catch()?;
        if let Some(path) = &self.apply {
            let calibration = Calibration::load(path)?;
            return store(&self.arm, calibration);
        }
        let Some(out) = &self.out else {
            bail!("say where to write with --out");
        };
        ensure!(
            out.extension().is_some_and(|ending| ending == "json"),
            "{}: a calibration is a .json file",
            out.display()
        );
        let mut session = Session::open(&self.arm, stop)?;
        let calibration = session.record(self.format, &self.whole_turn)?;
        drop(session);
        calibration.save(out)?;
        say!("wrote {}", out.display())?;
        store(&self.arm, calibration)
    }
}

/// Stores a calibration in the servos.
fn store(arm: &Arm, calibration: Calibration) -> Result<()> {
    let mut controller =
        robot_arm::controller::ServoController::new(arm.port.open()?, calibration)?;
    // What differs is about to be changed.
    drop(controller.take_warnings());
    controller.apply_calibration()?;
    controller
        .bus()
        .wait(std::time::Duration::from_millis(10))?;
    say!("stored offsets and limits in the servos")?;
    Ok(())
}
