//! Records a motion.

use std::{path::PathBuf, time::Duration};

use anyhow::{Result, ensure};
use robot_arm::{
    controller::ServoController,
    motion::{Motion, Sample},
};

use super::{connection::Arm, output::say, stop::Stop};

#[derive(clap::Args)]
#[command(
    after_help = "The torque goes off: hold the arm, and move it by hand. Ctrl-C ends the recording.

Examples:
  armctl record --port /dev/ttyACM0 --arm left_arm.json wave.mcap
  armctl record --port /dev/ttyACM0 --arm left_arm.json wave.json --seconds 10
  armctl record --port /dev/ttyACM0 --arm left_arm.json wave.json --keep-torque    while another pose is held"
)]
pub struct Record {
    #[command(flatten)]
    arm: Arm,
    /// File to write: .json or .mcap
    file: PathBuf,
    /// Samples a second
    #[arg(long, value_name = "HZ", default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..=500))]
    rate: u32,
    /// End after so many seconds
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Leave the torque as it is
    #[arg(long)]
    keep_torque: bool,
}

impl Record {
    pub fn run(self) -> Result<()> {
        let stop = Stop::catch()?;
        let mut arm = self.arm.open()?;
        let mut recorder = Recorder::new(&mut arm);
        // A file that cannot be written is found before the motion is made.
        recorder.motion.save(&self.file)?;
        if !self.keep_torque {
            arm.release()?;
        }
        say!("recording; Ctrl-C ends")?;
        let period = Duration::from_secs(1) / self.rate;
        let mut next = arm.bus().now();
        while !stop.is_caught()
            && self
                .seconds
                .is_none_or(|end| recorder.motion.duration_s() < end)
        {
            let positions = arm.read_positions()?;
            recorder.take(&mut arm, &positions.steps)?;
            next += period;
            arm.bus().wait_until(next)?;
        }
        recorder.save(&self.file)
    }
}

/// Collects samples. A moment at which a joint did not answer is left out.
pub struct Recorder {
    motion: Motion,
    started: Duration,
    left_out: u64,
}

impl Recorder {
    pub fn new(arm: &mut ServoController) -> Self {
        Self {
            motion: Motion::new(arm.joint_names()),
            started: arm.bus().now(),
            left_out: 0,
        }
    }

    pub fn take(
        &mut self,
        arm: &mut ServoController,
        positions: &std::collections::BTreeMap<String, i32>,
    ) -> Result<()> {
        let steps: Option<Vec<i32>> = self
            .motion
            .joints()
            .iter()
            .map(|j| positions.get(j).copied())
            .collect();
        let Some(steps) = steps else {
            self.left_out += 1;
            return Ok(());
        };
        if self.motion.samples().is_empty() {
            self.started = arm.bus().now();
        }
        let time_s = (arm.bus().now() - self.started).as_secs_f64();
        Ok(self.motion.push(Sample { time_s, steps })?)
    }

    pub fn save(self, file: &std::path::Path) -> Result<()> {
        ensure!(
            !self.motion.samples().is_empty(),
            "nothing was recorded: no moment had all joints"
        );
        self.motion.save(file)?;
        say!(
            "{}: {} samples, {:.1} s, {} moments left out",
            file.display(),
            self.motion.samples().len(),
            self.motion.duration_s(),
            self.left_out
        )?;
        Ok(())
    }
}
