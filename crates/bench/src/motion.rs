//! The input of the filters: a recorded trial, or a motion computed here.

mod computed;

use robot_estimator_bench::mailbox::Input;
use robot_replay::{FIELD_AGE_US, Sample, Trial};

/// The board's clock at time 0 of the motion. It is not 0, which stands for "no sample yet".
const START_US: u64 = 1_000_000;
const TICK_US: u64 = 1_000;
pub const TICKS_A_SAMPLE: u64 = 5;
/// The wheels' reports come every millisecond.
const WHEEL_AGE_US: u32 = 1_000;
const TOP_RPM: f64 = 2_000.0;

pub enum Motion {
    /// The sensor was moved without a robot around it, so no wheel ever reports.
    Recorded(Trial),
    Computed {
        samples: Vec<Sample>,
        wheels: Wheels,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wheels {
    Silent,
    Turning,
}

/// What is new in a tick of 1 ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewSamples {
    ImuAndMag,
    Imu,
    Nothing,
}

impl Motion {
    pub fn name(&self) -> &str {
        match self {
            Self::Recorded(trial) => &trial.name,
            Self::Computed { .. } => "computed motion",
        }
    }

    pub fn samples(&self) -> &[Sample] {
        match self {
            Self::Recorded(trial) => &trial.samples,
            Self::Computed { samples, .. } => samples,
        }
    }

    pub fn wheels(&self) -> Wheels {
        match self {
            Self::Recorded(_) => Wheels::Silent,
            Self::Computed { wheels, .. } => *wheels,
        }
    }

    /// Returns the control loop's ticks as `robot_replay::run` makes them, each with its time in the motion. Every
    /// fifth tick has an IMU sample, and every fourth of those has a magnetometer sample too.
    pub fn ticks(&self) -> impl Iterator<Item = (u64, NewSamples, Input)> {
        let mut latest = Input {
            wheel_age_us: u32::MAX,
            ..Input::default()
        };
        self.samples()
            .iter()
            .flat_map(move |sample| {
                let fresh = deliver(sample, &mut latest);
                (0..TICKS_A_SAMPLE).map(move |tick| {
                    let t_us = sample.end_us + tick * TICK_US;
                    let fresh = if tick == 0 {
                        fresh
                    } else {
                        NewSamples::Nothing
                    };
                    let now_us = clock_us(t_us);
                    (t_us, fresh, Input { now_us, ..latest })
                })
            })
            .map(|(t_us, fresh, input)| (t_us, fresh, self.with_wheels(input)))
    }

    fn with_wheels(&self, input: Input) -> Input {
        if self.wheels() == Wheels::Silent {
            return input;
        }
        let rpm = TOP_RPM * (f64::from(input.now_us) * 1e-6).sin();
        Input {
            wheel_rpm: [rpm as i16, -rpm as i16],
            wheel_age_us: WHEEL_AGE_US,
            ..input
        }
    }
}

fn deliver(sample: &Sample, latest: &mut Input) -> NewSamples {
    let Some(motion) = &sample.motion else {
        return NewSamples::Nothing;
    };
    latest.imu_ts_us = clock_us(sample.end_us);
    latest.gyro_rps = motion.gyro_rps;
    latest.accel_mps2 = motion.accel_mps2;
    let Some(mag_ut) = sample.field_ut else {
        return NewSamples::Imu;
    };
    latest.mag_ts_us = clock_us(sample.end_us) - FIELD_AGE_US as u32;
    latest.mag_ut = mag_ut;
    NewSamples::ImuAndMag
}

/// Returns the board's time. A motion lasts minutes, and the mailbox counts to an hour.
fn clock_us(t_us: u64) -> u32 {
    (START_US + t_us) as u32
}
