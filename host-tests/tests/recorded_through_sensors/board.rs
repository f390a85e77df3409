//! The board's sensor tasks and the estimator's part of the control tick, while a recording plays.

use std::path::Path;

use robot_app::{
    domain::{
        ImuState, MagState, MotorFeedback, MountingConfig, Orientation, StateEstimate,
        WheelOdomConfig,
    },
    estimation::InsEstimator,
};
use robot_host_loop::Sensors;
use robot_plant::{
    recording,
    time::{MS, Ps, US},
    world::{PlantKind, World, WorldConfig},
};
use robot_replay::{Mode, Run, Tick};

const IMU_PERIOD: Ps = 5 * MS;
const MAG_PERIOD: Ps = 20 * MS;
/// The tick runs half a millisecond after the sensors are read.
const TICK_PHASE: Ps = 500 * US;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wheels {
    /// There is no wheel feedback.
    Silent,
    /// The wheels report that they stand, as on a robot that is carried about.
    Standing,
}

impl Wheels {
    fn feedback(self, now_us: u64) -> MotorFeedback {
        let mut feedback = MotorFeedback::default();
        if self == Self::Standing {
            for wheel in &mut feedback.wheels {
                wheel.age_us = 300;
                wheel.ts_us = now_us - 300;
            }
        }
        feedback
    }
}

/// Plays a recording. Returns the outputs from its beginning and the number of rejected IMU samples. `phase` is the
/// time of the IMU's readings against the chips' own clocks.
pub fn play(header: &Path, phase: Ps, wheels: Wheels) -> anyhow::Result<(Run, u32)> {
    let mut world = World::new(WorldConfig {
        plant: PlantKind::Stand,
        seed: 1,
        imu_trial: Some(header.to_owned()),
        ..WorldConfig::default()
    })?;
    let end = recording::run_length(header)?;
    let mut board = Board::bring_up(&mut world, phase, wheels);
    let mut ticks = Vec::new();
    while board.tick_at < end {
        let now = board.tick_at;
        board.step(&mut world);
        if let Some(since) = now.checked_sub(recording::LEAD_IN) {
            ticks.push(Tick::new(since / US, &board.estimate));
        }
    }
    assert!(board.sensors.imu_calibrated(), "the record begins at rest");
    let run = Run {
        mode: Mode::NineAxis,
        ticks,
    };
    Ok((run, board.rejected))
}

struct Board {
    sensors: Sensors,
    estimator: InsEstimator,
    wheels: Wheels,
    imu: ImuState,
    mag: MagState,
    estimate: StateEstimate,
    rejected: u32,
    imu_at: Ps,
    mag_at: Ps,
    tick_at: Ps,
}

impl Board {
    fn bring_up(world: &mut World, phase: Ps, wheels: Wheels) -> Self {
        let mut sensors = Sensors::new();
        // The recorder's axes are those of the robot.
        sensors.set_mounting(&MountingConfig {
            board: Orientation::XForwardZUp,
            mag: Some(Orientation::XForwardZUp),
        });
        let up = sensors.bring_up(world, 0).next_multiple_of(MAG_PERIOD);
        Self {
            sensors,
            estimator: InsEstimator::new(WheelOdomConfig::default()),
            wheels,
            imu: ImuState::default(),
            mag: MagState::default(),
            estimate: StateEstimate::default(),
            rejected: 0,
            imu_at: up + phase,
            mag_at: up,
            tick_at: up + TICK_PHASE,
        }
    }

    /// Serves the sensors up to the next tick, then ticks.
    fn step(&mut self, world: &mut World) {
        while self.imu_at.min(self.mag_at) <= self.tick_at {
            if self.imu_at <= self.mag_at {
                match self.sensors.read_imu(world, self.imu_at) {
                    Ok(state) => self.imu = state,
                    Err(_) => self.rejected += 1,
                }
                self.imu_at += IMU_PERIOD;
            } else {
                self.sensors.start_mag(world, self.mag_at);
                self.mag_at += MAG_PERIOD;
            }
        }
        if let Ok(Some(state)) = self.sensors.fetch_mag(world, self.tick_at) {
            self.mag = state;
        }
        let now_us = self.tick_at / US;
        let motor = self.wheels.feedback(now_us);
        self.estimator
            .step(&self.imu, &self.mag, &motor, now_us, &mut self.estimate);
        self.tick_at += MS;
    }
}
