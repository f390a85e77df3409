//! Measures the bus, and the speed of inverse kinematics.

use anyhow::Result;
use robot_arm::{
    bus::{
        Block, ServoBus,
        register::{GOAL_POSITION, PRESENT_POSITION, RETURN_DELAY, Register},
    },
    ik::{self, Mask},
    kinematics::create_so101_5dof,
};
use serde_json::json;

use super::{connection::Port, output::say};

#[derive(clap::Args)]
#[command(
    after_help = "The bus is measured if there is a --port. Each loop reads the positions of all servos and writes \
the goals that they have, so that nothing moves; the torque stays as it is.

Examples:
  armctl bench --json
  armctl bench --port /dev/ttyACM0 --seconds 10"
)]
pub struct Bench {
    #[command(flatten)]
    port: Port,
    /// Ids of the servos
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2, 3, 4, 5, 6])]
    ids: Vec<u8>,
    /// Time for the bus
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    seconds: f64,
    /// Poses for inverse kinematics
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    poses: usize,
    /// Seed of the poses
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Print the figures for scripts
    #[arg(long)]
    json: bool,
}

/// What was measured of the bus.
#[derive(serde::Serialize)]
struct BusFigures {
    hz: f64,
    loops: u64,
    /// Loops in which a servo did not answer.
    incomplete: u64,
    servos: usize,
    statistics: robot_arm::bus::Statistics,
}

impl Bench {
    pub fn run(self) -> Result<()> {
        let bus = match self.port.port {
            Some(_) => Some(self.bus(&mut self.port.open()?)?),
            None => None,
        };
        let robot = create_so101_5dof();
        let position = ik::measure(&robot, Mask::POSITION, self.poses, self.seed)?;
        let without_yaw = ik::measure(&robot, Mask::WITHOUT_YAW, self.poses, self.seed)?;
        if self.json {
            let figures = json!({ "bus": bus, "ik": position, "ik_without_yaw": without_yaw });
            say!("{figures}")?;
            return Ok(());
        }
        match &bus {
            Some(bus) => say!(
                "bus: {:.0} loops/s over {} servos, {} loops, {} incomplete, {:?}",
                bus.hz,
                bus.servos,
                bus.loops,
                bus.incomplete,
                bus.statistics
            )?,
            None => say!("bus: not measured, as no --port was given")?,
        }
        for (name, ik) in [("place", position), ("place, without yaw", without_yaw)] {
            say!(
                "inverse kinematics, {name}: {} of {} solved, mean {:.1} µs, p99 {:.1} µs",
                ik.solved,
                ik.poses,
                ik.mean_us,
                ik.p99_us
            )?;
        }
        Ok(())
    }

    fn bus(&self, bus: &mut ServoBus) -> Result<BusFigures> {
        let mut goals = Vec::new();
        for id in &self.ids {
            // The servo's own delay is part of its time-out.
            bus.read(*id, RETURN_DELAY)?;
            goals.push((*id, [(GOAL_POSITION, bus.read(*id, GOAL_POSITION)?.value)]));
        }
        let goals: Vec<(u8, &[(Register, i32)])> =
            goals.iter().map(|(id, goal)| (*id, &goal[..])).collect();
        let before = bus.now();
        let (mut loops, mut incomplete) = (0, 0);
        let mut elapsed_s = 0.0;
        while elapsed_s < self.seconds {
            let readings = bus.sync_read(&self.ids, Block::from(PRESENT_POSITION))?;
            incomplete += u64::from(readings.iter().any(Result::is_err));
            bus.sync_write(&goals)?;
            loops += 1;
            elapsed_s = (bus.now() - before).as_secs_f64();
        }
        Ok(BusFigures {
            hz: f64::from(u32::try_from(loops)?) / elapsed_s,
            loops,
            incomplete,
            servos: self.ids.len(),
            statistics: bus.statistics(),
        })
    }
}
