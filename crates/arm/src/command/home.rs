//! Moves all joints home.

use std::time::Duration;

use anyhow::{Result, ensure};

use super::{
    connection::{MovingArm, warn},
    output::say,
    stop::Stop,
};

#[derive(clap::Args)]
#[command(after_help = "Examples:
  armctl home --port /dev/ttyACM0 --arm left_arm.json
  armctl home --port /dev/ttyACM0 --arm left_arm.json --seconds 5 --at-end release")]
pub struct Home {
    #[command(flatten)]
    arm: MovingArm,
    /// Time of the motion
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    seconds: f64,
}

/// Goals a second.
const GOALS_HZ: f64 = 50.0;

impl Home {
    pub fn run(self) -> Result<()> {
        ensure!(
            (0.5..=60.0).contains(&self.seconds),
            "--seconds {}: a motion home takes 0.5 to 60 s",
            self.seconds
        );
        let stop = Stop::catch()?;
        let mut arm = self.arm.open()?;
        arm.set_stop_flag(stop.flag());
        let steps = (self.seconds * GOALS_HZ) as u32;
        arm.soft_move_to_home(steps, Duration::from_secs_f64(1.0 / GOALS_HZ))?;
        warn(&mut arm)?;
        let positions = arm.read_positions()?;
        for (joint, steps) in &positions.steps {
            say!("{joint:<16} {steps:5} steps")?;
        }
        say!("home")?;
        Ok(())
    }
}
