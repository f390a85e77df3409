//! Plays a recorded motion.

use std::{collections::BTreeMap, path::PathBuf, time::Duration};

use anyhow::{Context, Result, ensure};
use robot_arm::motion::{Motion, Sample};

use super::{
    connection::{MovingArm, warn},
    output::say,
    stop::Stop,
};

#[derive(clap::Args)]
#[command(
    after_help = "The arm goes softly to where the motion begins, then plays it. Ctrl-C stops it where it is.

Examples:
  armctl play --port /dev/ttyACM0 --arm left_arm.json wave.mcap
  armctl play --port /dev/ttyACM0 --arm left_arm.json wave.json --speed 0.5"
)]
pub struct Play {
    #[command(flatten)]
    arm: MovingArm,
    /// Recorded motion: .json or .mcap
    file: PathBuf,
    /// 1 is as fast as it was recorded
    #[arg(long, default_value_t = 1.0)]
    speed: f64,
}

/// The way to the first pose.
const APPROACH_STEPS: u32 = 100;
const APPROACH_INTERVAL: Duration = Duration::from_millis(20);

impl Play {
    pub fn run(self) -> Result<()> {
        ensure!(
            (0.1..=2.0).contains(&self.speed),
            "--speed {}: it takes 0.1 to 2",
            self.speed
        );
        let motion = Motion::load(&self.file)?;
        let stop = Stop::catch()?;
        let mut arm = self.arm.open()?;
        arm.set_stop_flag(stop.flag());
        let pose = |sample: &Sample| -> BTreeMap<String, i32> {
            motion
                .joints()
                .iter()
                .cloned()
                .zip(sample.steps.iter().copied())
                .collect()
        };
        let first = motion.samples().first().context("the motion is empty")?;
        arm.soft_move_to_pose(&pose(first), APPROACH_STEPS, APPROACH_INTERVAL)?;
        let started = arm.bus().now();
        for sample in motion.samples() {
            if stop.is_caught() {
                arm.hold()?;
                say!("stopped")?;
                return Ok(());
            }
            let at_s = (sample.time_s - first.time_s) / self.speed;
            arm.bus()
                .wait_until(started + Duration::try_from_secs_f64(at_s)?)?;
            arm.fast_move_to_pose(&pose(sample), 0)?;
        }
        warn(&mut arm)?;
        say!("played {:.1} s", motion.duration_s() / self.speed)?;
        Ok(())
    }
}
