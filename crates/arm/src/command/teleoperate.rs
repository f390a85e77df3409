//! Lets one arm follow another.

use std::{path::PathBuf, time::Duration};

use anyhow::{Context, Result, ensure};
use robot_arm::{
    bus::ServoBus, calibration::Calibration, controller::ServoController, motion::Follower,
};

use super::{
    connection::{MovingArm, warn},
    output::say,
    record::Recorder,
    stop::Stop,
};

#[derive(clap::Args)]
#[command(
    after_help = "The leader has no torque and is moved by hand; the follower first goes softly to the leader's pose. Ctrl-C \
ends. --port and --arm are the follower's.

Example:
  armctl teleoperate --leader /dev/ttyACM1 --leader-arm leader.json --port /dev/ttyACM0 --arm follower.json --record wave.mcap"
)]
pub struct Teleoperate {
    #[command(flatten)]
    follower: MovingArm,
    /// Serial port of the leader
    #[arg(long, value_name = "PORT")]
    leader: String,
    /// Calibration of the leader
    #[arg(long, value_name = "FILE")]
    leader_arm: PathBuf,
    /// Record the follower's motion: .json or .mcap
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Poses a second
    #[arg(long, value_name = "HZ", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=500))]
    rate: u32,
    /// End after so many seconds
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
}

/// The follower's way to the leader's pose.
const APPROACH_STEPS: u32 = 100;
const APPROACH_INTERVAL: Duration = Duration::from_millis(20);
/// Speed of a joint whose leader did not answer for a while: 45 degrees a second.
const CATCH_UP_STEPS_S: i32 = 500;

impl Teleoperate {
    pub fn run(self) -> Result<()> {
        ensure!(
            self.follower.arm.arm.is_some(),
            "name the follower's calibration with --arm: ranges of both arms are needed (armctl calibrate)"
        );
        let stop = Stop::catch()?;
        let calibration = Calibration::load(&self.leader_arm)?;
        let mut follower = self.follower.open()?;
        follower.set_stop_flag(stop.flag());
        let mut mapping = Follower::new(&calibration, follower.calibration());
        ensure!(
            mapping.missing().is_empty(),
            "the follower has no joint called {}: give both calibrations the same names",
            mapping.missing().join(", ")
        );
        let bus = ServoBus::open(&self.leader, self.follower.arm.port.baud)?;
        let mut leader = ServoController::new(bus, calibration).context("the leader")?;
        warn(&mut leader)?;
        leader.release()?;
        let catch_up = (CATCH_UP_STEPS_S / self.rate as i32).max(1);
        let targets = mapping.targets(&leader.read_servo_positions()?, catch_up);
        follower.soft_move_to_pose(&targets, APPROACH_STEPS, APPROACH_INTERVAL)?;
        say!("the follower follows; Ctrl-C ends")?;
        let mut recorder = Recorder::new(&mut follower);
        let period = Duration::from_secs(1) / self.rate;
        let started = follower.bus().now();
        let mut next = started;
        while !stop.is_caught() {
            let elapsed = follower.bus().now() - started;
            if self.seconds.is_some_and(|end| elapsed.as_secs_f64() >= end) {
                break;
            }
            let targets = mapping.targets(&leader.read_positions()?.steps, catch_up);
            follower.fast_move_to_pose(&targets, 0)?;
            let positions = follower.read_positions()?;
            if self.record.is_some() {
                recorder.take(&mut follower, &positions.steps)?;
            }
            warn(&mut follower)?;
            next += period;
            follower.bus().wait_until(next)?;
        }
        follower.hold()?;
        match &self.record {
            Some(file) => recorder.save(file),
            None => Ok(()),
        }
    }
}
