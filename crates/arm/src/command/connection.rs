//! The options that say where the arm is, and which.

use std::{path::PathBuf, time::Duration};

use anyhow::{Context, Result, bail};
use robot_arm::{
    bus::ServoBus,
    calibration::Calibration,
    controller::{Ending, ServoController},
};

use super::output::say;

/// Where the bus is.
#[derive(clap::Args)]
pub struct Port {
    /// Serial port of the servo adapter: /dev/ttyACM0, COM5, /dev/cu.usbmodem1101, or that of `armctl sim`
    #[arg(long, value_name = "PORT")]
    pub port: Option<String>,
    /// Speed of the servos in bits per second
    #[arg(long, value_name = "BPS", default_value_t = 1_000_000, value_parser = clap::value_parser!(u32).range(9600..=4_000_000))]
    pub baud: u32,
    /// What computer and adapter may add to the time of an answer, in ms
    #[arg(long, value_name = "MS", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub slack: u64,
}

impl Port {
    pub fn open(&self) -> Result<ServoBus> {
        let mut bus = ServoBus::open(&self.name()?, self.baud)?;
        bus.set_host_slack(Duration::from_millis(self.slack));
        Ok(bus)
    }

    pub fn name(&self) -> Result<String> {
        if let Some(port) = &self.port {
            return Ok(port.clone());
        }
        let ports = serialport::available_ports().unwrap_or_default();
        let names: Vec<String> = ports.into_iter().map(|port| port.port_name).collect();
        match &names[..] {
            [] => bail!(
                "say which port with --port; this computer has none: is the adapter plugged in?"
            ),
            names => bail!(
                "say which port with --port; this computer has {}",
                names.join(", ")
            ),
        }
    }
}

/// Which arm is there.
#[derive(clap::Args)]
pub struct Arm {
    #[command(flatten)]
    pub port: Port,
    /// Calibration of the arm (left_arm.json, or LeRobot's file). Without one: the joints of an SO-101 with ids 1 to 6 and no limits
    #[arg(long, value_name = "FILE")]
    pub arm: Option<PathBuf>,
}

impl Arm {
    pub fn calibration(&self) -> Result<Calibration> {
        match &self.arm {
            Some(path) => Ok(Calibration::load(path)?),
            None => Ok(Calibration::so101()),
        }
    }

    /// Opens the arm and says what its servos do not agree with.
    pub fn open(&self) -> Result<ServoController> {
        let calibration = self.calibration()?;
        let bus = self.port.open()?;
        let mut arm =
            ServoController::new(bus, calibration).context("not all servos of the arm answer")?;
        warn(&mut arm)?;
        Ok(arm)
    }
}

/// An arm that will move.
#[derive(clap::Args)]
pub struct MovingArm {
    #[command(flatten)]
    pub arm: Arm,
    /// What the arm does when this command ends: hold its place, or release, by which it falls
    #[arg(long, value_name = "hold|release", default_value = "hold")]
    pub at_end: Ending,
}

impl MovingArm {
    pub fn open(&self) -> Result<ServoController> {
        if self.arm.arm.is_none() {
            say!(
                "without --arm there are no limits: keep clear of the arm, and calibrate it (armctl calibrate)"
            )?;
        }
        let mut arm = self.arm.open()?;
        arm.set_ending(self.at_end);
        Ok(arm)
    }
}

/// Prints what the arm warns of.
pub fn warn(arm: &mut ServoController) -> Result<()> {
    for warning in arm.take_warnings() {
        say!("warning: {warning}")?;
    }
    Ok(())
}
