//! Brings joints back that protect themselves.

use anyhow::{Result, ensure};
use robot_arm::controller::Recovery;

use super::{connection::Arm, output::say};

#[derive(clap::Args)]
#[command(
    after_help = "A joint that comes back holds the place where it is. For a moment it has no torque.

Examples:
  armctl recover --port /dev/ttyACM0 --arm left_arm.json
  armctl recover --port /dev/ttyACM0 --arm left_arm.json gripper"
)]
pub struct Recover {
    #[command(flatten)]
    arm: Arm,
    /// Joints; without one, all
    joints: Vec<String>,
}

impl Recover {
    pub fn run(self) -> Result<()> {
        let mut arm = self.arm.open()?;
        let joints = if self.joints.is_empty() {
            arm.joint_names()
        } else {
            self.joints
        };
        let mut left = 0;
        for joint in joints {
            let recovery = arm.recover(&joint)?;
            left += usize::from(!matches!(
                recovery,
                Recovery::Fine | Recovery::Recovered { .. }
            ));
            say!("{joint:<16} {recovery}")?;
        }
        ensure!(left == 0, "{left} joints still protect themselves");
        Ok(())
    }
}
