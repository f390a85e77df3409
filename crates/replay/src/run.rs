//! Runs the estimator over a whole recording, as the control tick does.

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
    estimation::InsEstimator,
};
use robot_plant::attitude::{self, Quaternion};

use crate::{
    resample::{FIELD_AGE_US, Sample},
    track::Track,
    trial::Trial,
};

const TICK_US: u64 = 1_000;
/// The firmware's clock at time 0 of the recording. It is not 0, which stands for "no sample yet".
const START_US: u64 = 1_000_000;

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
pub enum Mode {
    /// The magnetometer is used, so the heading is absolute.
    #[value(name = "9d")]
    #[serde(rename = "9d")]
    NineAxis,
    /// The magnetometer is not used, so the heading starts anywhere and drifts.
    #[value(name = "6d")]
    #[serde(rename = "6d")]
    SixAxis,
}

/// One output of the estimator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Time in the recording.
    pub t_us: u64,
    /// Unit quaternion from body to ENU earth, scalar first.
    pub q_wxyz: Quaternion,
    pub gyro_bias_rps: [f32; 3],
    pub valid: bool,
}

impl Tick {
    /// Normalises the quaternion, whose length is off by about 1e-7 in single precision. It becomes NaN if it cannot be
    /// normalised.
    pub fn new(t_us: u64, estimate: &StateEstimate) -> Self {
        let unit = attitude::normalised(estimate.q_wxyz.map(f64::from));
        Self {
            t_us,
            q_wxyz: unit.unwrap_or([f64::NAN; 4]),
            gyro_bias_rps: estimate.gyro_bias_rps,
            valid: estimate.valid,
        }
    }
}

/// All outputs of a run, one for each millisecond.
pub struct Run {
    pub mode: Mode,
    pub ticks: Vec<Tick>,
}

impl Run {
    pub(crate) fn track(&self) -> Track {
        let first_us = self.ticks.first().map_or(0, |tick| tick.t_us);
        Track {
            start_s: first_us as f64 * 1e-6,
            period_s: TICK_US as f64 * 1e-6,
            attitudes: self.ticks.iter().map(|tick| tick.q_wxyz).collect(),
        }
    }
}

/// Steps a new estimator as the control tick does, from the first sample of `trial` to its end. `gyro_offset_dps` is
/// added to every gyro sample, like an offset that start-up calibration has missed.
pub fn run(trial: &Trial, mode: Mode, gyro_offset_dps: [f32; 3]) -> Run {
    let mut estimator = InsEstimator::new(WheelOdomConfig::default());
    let mut sensors = Sensors::new(mode, gyro_offset_dps);
    let motor = MotorFeedback::default();
    let mut estimate = StateEstimate::default();
    let mut ticks = Vec::new();
    let mut samples = trial.samples.iter().peekable();
    let first_us = trial.samples.first().map_or(0, |sample| sample.end_us);
    let last_us = trial.samples.last().map_or(0, |sample| sample.end_us);
    for t_us in (first_us..=last_us).step_by(TICK_US as usize) {
        if let Some(sample) = samples.next_if(|sample| sample.end_us <= t_us) {
            sensors.deliver(sample);
        }
        let now_us = START_US + t_us;
        estimator.step(&sensors.imu, &sensors.mag, &motor, now_us, &mut estimate);
        ticks.push(Tick::new(t_us, &estimate));
    }
    Run { mode, ticks }
}

/// The latest samples, as the sensor task passes them to the control task.
struct Sensors {
    mode: Mode,
    gyro_offset_dps: [f32; 3],
    imu: ImuState,
    mag: MagState,
}

impl Sensors {
    fn new(mode: Mode, gyro_offset_dps: [f32; 3]) -> Self {
        Self {
            mode,
            gyro_offset_dps,
            imu: ImuState::default(),
            mag: MagState::default(),
        }
    }

    fn deliver(&mut self, sample: &Sample) {
        if let Some(motion) = &sample.motion {
            let gyro_dps = motion.gyro_rps.map(f32::to_degrees);
            self.imu = ImuState {
                accel_mps2: motion.accel_mps2,
                gyro_dps: std::array::from_fn(|axis| gyro_dps[axis] + self.gyro_offset_dps[axis]),
                saturated: motion.saturated,
                gyro_clipped_ms: motion.gyro_clipped_ms,
                ts_us: START_US + sample.end_us,
                ..ImuState::default()
            };
        }
        if let (Mode::NineAxis, Some(mag_ut)) = (self.mode, sample.field_ut) {
            self.mag = MagState {
                mag_ut,
                ts_us: START_US + sample.end_us - FIELD_AGE_US,
            };
        }
    }
}
