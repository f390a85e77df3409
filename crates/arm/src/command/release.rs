//! Switches the torque off.

use anyhow::Result;

use super::{connection::Arm, output::say};

#[derive(clap::Args)]
#[command(after_help = "Hold the arm: it falls.

Example:
  armctl release --port /dev/ttyACM0")]
pub struct Release {
    #[command(flatten)]
    arm: Arm,
}

impl Release {
    pub fn run(self) -> Result<()> {
        let mut arm = self.arm.open()?;
        arm.release()?;
        say!("no joint has torque")?;
        Ok(())
    }
}
