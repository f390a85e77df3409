//! How the sensors measure the truth.

use robot_test_support::Vector;

use crate::motion::OverTime;

/// Standard deviations of one sample.
#[derive(Clone, Copy, Debug)]
pub struct NoiseLevel {
    pub gyro_dps: f64,
    pub accel_mps2: f64,
    pub mag_ut: f64,
}

/// When samples are taken and delivered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Timing {
    /// Every 5 ms exactly, delivered in the same tick.
    Exact,
    /// Taken up to 2 ms early or late, with true time stamps.
    Jitter,
    /// Taken every 5 ms, with time stamps up to 2 ms wrong.
    WrongStamps,
    /// Taken every 5 ms, delivered 1 … 9 ms later.
    Late,
}

pub struct Sensors {
    pub noise: NoiseLevel,
    /// The gyro bias in °/s, over time.
    pub gyro_offset_dps: OverTime,
    /// The part of that bias in °/s that a calibration has removed from the samples, over time.
    pub removed_bias_dps: OverTime,
    /// Measured rate from true rate, rows x, y, z: scale, and angles between the axes.
    pub gyro_matrix: [Vector; 3],
    /// A larger rate saturates and marks the sample.
    pub gyro_range_dps: f64,
    pub accel_range_mps2: f64,
    /// Hard iron, body frame.
    pub hard_iron_ut: Vector,
    /// Delay of the magnetometer beyond its time stamp.
    pub unknown_mag_delay_us: u64,
    /// Whether there is a magnetometer at this time.
    pub has_mag: Box<dyn Fn(f64) -> bool>,
    /// Whether the IMU sample with this number is lost.
    pub loses: Box<dyn Fn(u64) -> bool>,
    pub timing: Timing,
    pub seed: u64,
    /// The robot's clock when the motion starts.
    pub start_us: u64,
}

impl Sensors {
    /// No noise, no bias, with magnetometer.
    pub fn ideal() -> Self {
        Self {
            noise: NoiseLevel {
                gyro_dps: 0.0,
                accel_mps2: 0.0,
                mag_ut: 0.0,
            },
            gyro_offset_dps: Box::new(|_| [0.0; 3]),
            removed_bias_dps: Box::new(|_| [0.0; 3]),
            gyro_matrix: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            gyro_range_dps: 2_000.0,
            accel_range_mps2: 117.7,
            hard_iron_ut: [0.0; 3],
            unknown_mag_delay_us: 0,
            has_mag: Box::new(|_| true),
            loses: Box::new(|_| false),
            timing: Timing::Exact,
            seed: 3,
            start_us: 1_000_000,
        }
    }

    /// Noise by the datasheets: BMI088 0.014 °/s/√Hz and 175 µg/√Hz over 100 Hz, IST8310 0.3 µT.
    pub fn real() -> Self {
        Self {
            noise: NoiseLevel {
                gyro_dps: 0.14,
                accel_mps2: 0.017,
                mag_ut: 0.3,
            },
            ..Self::ideal()
        }
    }

    pub fn without_mag(mut self) -> Self {
        self.has_mag = Box::new(|_| false);
        self
    }

    pub fn with_mag_while(mut self, has_mag: impl Fn(f64) -> bool + 'static) -> Self {
        self.has_mag = Box::new(has_mag);
        self
    }

    pub fn with_offset(mut self, offset_dps: [f64; 3]) -> Self {
        self.gyro_offset_dps = Box::new(move |_| offset_dps);
        self
    }

    pub fn losing(mut self, loses: impl Fn(u64) -> bool + 'static) -> Self {
        self.loses = Box::new(loses);
        self
    }

    pub fn timed(mut self, timing: Timing) -> Self {
        self.timing = timing;
        self
    }
}
