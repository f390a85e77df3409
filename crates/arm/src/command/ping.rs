//! Asks servos whether they are there.

use anyhow::{Result, ensure};

use super::{connection::Port, output::say};

#[derive(clap::Args)]
#[command(after_help = "Example:
  armctl ping --port /dev/ttyACM0 1 2 3 4 5 6")]
pub struct Ping {
    #[command(flatten)]
    port: Port,
    /// Ids
    #[arg(required = true, value_parser = clap::value_parser!(u8).range(0..=253))]
    ids: Vec<u8>,
}

impl Ping {
    pub fn run(self) -> Result<()> {
        let mut bus = self.port.open()?;
        let mut missing = 0;
        for id in self.ids {
            match bus.ping(id) {
                Ok(alarms) => say!("servo {id}: alarms: {alarms}")?,
                Err(robot_arm::bus::BusError::Servo(error)) => {
                    missing += 1;
                    say!("{error}")?;
                }
                Err(error) => return Err(error.into()),
            }
        }
        ensure!(missing == 0, "{missing} servos did not answer");
        Ok(())
    }
}
