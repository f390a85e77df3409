//! What the filters are fed with: a recorded trial, or a motion computed here.

mod computed;
mod recorded;

use estimator_bench::mailbox::Input;

pub const ROW_US: u32 = 5_000;
const TICK_US: u32 = 1_000;
/// Rows a magnetometer sample: 50 Hz.
const ROWS_A_MAG_SAMPLE: usize = 4;
const START_US: u32 = 1_000_000;
/// The wheels' reports come every millisecond.
const WHEEL_AGE_US: u32 = 1_000;

/// Means of 5 ms, and the attitude (body → ENU, w first) at their end where it is known and scored.
#[derive(Clone, Debug)]
pub struct Row {
    pub gyro_rps: [f32; 3],
    pub accel_mps2: [f32; 3],
    pub mag_ut: [f32; 3],
    pub reference_wxyz: Option<[f64; 4]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wheels {
    /// They never report, as in a recording of a sensor alone.
    Silent,
    Turning,
}

#[derive(Clone, Debug)]
pub struct Motion {
    pub name: String,
    pub rows: Vec<Row>,
    pub wheels: Wheels,
}

/// What is new in a tick of 1 ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fresh {
    ImuAndMag,
    Imu,
    Nothing,
}

impl Motion {
    pub fn ticks_a_row() -> u32 {
        ROW_US / TICK_US
    }

    /// The ticks of 1 ms that begin with row `index`: the first has new samples.
    pub fn ticks(&self, index: usize) -> impl Iterator<Item = (Fresh, Input)> {
        let mag_index = index - index % ROWS_A_MAG_SAMPLE;
        let (row, mag_row) = (&self.rows[index], &self.rows[mag_index]);
        let imu_ts_us = row_end_us(index);
        let at_sample = Input {
            now_us: imu_ts_us,
            imu_ts_us,
            // The middle of its own row.
            mag_ts_us: row_end_us(mag_index) - ROW_US / 2,
            gyro_rps: row.gyro_rps,
            accel_mps2: row.accel_mps2,
            mag_ut: mag_row.mag_ut,
            wheel_rpm: [0; 2],
            wheel_age_us: u32::MAX,
        };
        (0..Self::ticks_a_row()).map(move |tick| {
            let fresh = match tick {
                0 if mag_index == index => Fresh::ImuAndMag,
                0 => Fresh::Imu,
                _ => Fresh::Nothing,
            };
            let now_us = imu_ts_us + tick * TICK_US;
            (
                fresh,
                self.with_wheels(Input {
                    now_us,
                    ..at_sample
                }),
            )
        })
    }

    fn with_wheels(&self, input: Input) -> Input {
        if self.wheels == Wheels::Silent {
            return input;
        }
        let rpm = 2_000.0 * (f64::from(input.now_us) * 1e-6).sin();
        Input {
            wheel_rpm: [rpm as i16, -rpm as i16],
            wheel_age_us: WHEEL_AGE_US,
            ..input
        }
    }
}

fn row_end_us(index: usize) -> u32 {
    START_US + index as u32 * ROW_US
}
