//! The calibration after power-on. It waits until the package is warm and the robot still, then measures the gyro bias.

use super::{startup_gyro_bias::StartupGyroBias, temperature_gate::TemperatureGate};
use crate::{
    domain::{CalibrationState, CalibrationStatus, TemperatureGateState},
    math::Vector3,
    sensing::heater::Heater,
};

/// One IMU sample in the robot's axes: the gyro with its bias, the accelerometer calibrated.
#[derive(Clone, Copy, Debug)]
pub struct CalibrationSample {
    pub gyro_dps: Vector3,
    pub accel_mps2: Vector3,
    /// The gyro bias in the settings.
    pub stored_offset_dps: Vector3,
    /// `None` while the sensor marks it invalid.
    pub temperature_c: Option<f32>,
    pub ts_us: u64,
}

/// The start-up calibration. It is fed with every good sample; once done, it stays done.
#[derive(Clone, Debug, Default)]
pub struct StartupCalibration {
    gate: TemperatureGate,
    gyro: StartupGyroBias,
    status: CalibrationStatus,
}

impl StartupCalibration {
    /// State, warmth and progress, for diagnostics.
    pub const fn status(&self) -> &CalibrationStatus {
        &self.status
    }

    /// The gyro bias in °/s, once measured.
    pub const fn gyro_bias_dps(&self) -> Option<Vector3> {
        self.gyro.bias_dps()
    }

    /// Takes a sample, with the heater as of that sample.
    pub fn feed(&mut self, sample: &CalibrationSample, heater: &Heater) {
        if self.status.state == CalibrationState::Done {
            return;
        }
        self.status.warmth = self.gate.step(sample.temperature_c, heater, sample.ts_us);
        self.status.state = if self.status.warmth == TemperatureGateState::Unsettled {
            self.gyro.restart();
            CalibrationState::WaitingForTemperature
        } else {
            self.gyro.feed(
                sample.gyro_dps,
                sample.accel_mps2,
                sample.stored_offset_dps,
                sample.ts_us,
            );
            if self.gyro.bias_dps().is_some() {
                CalibrationState::Done
            } else if self.gyro.refused() {
                CalibrationState::OffsetRefused
            } else if self.gyro.is_measuring() {
                CalibrationState::Measuring
            } else {
                CalibrationState::WaitingForStillness
            }
        };
        self.status.progress = self.gyro.progress();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::HeaterConfig;

    struct Bench {
        heater: Heater,
        calibration: StartupCalibration,
        stored_offset_dps: Vector3,
        ts_us: u64,
    }

    impl Bench {
        fn new() -> Self {
            Self {
                heater: Heater::new(HeaterConfig::default()),
                calibration: StartupCalibration::default(),
                stored_offset_dps: [0.0; 3],
                ts_us: 0,
            }
        }

        /// Samples at 200 Hz with a bias of 0.5 °/s on x that ripples by 0.1 °/s.
        fn run(&mut self, samples: u32, temperature_c: f32, turning_dps: f32) -> CalibrationStatus {
            for index in 0..samples {
                self.ts_us += 5_000;
                let ripple = if index % 2 == 0 { 0.1 } else { -0.1 };
                self.heater.step(Some(temperature_c), self.ts_us);
                self.calibration.feed(
                    &CalibrationSample {
                        gyro_dps: [0.5 + ripple, 0.0, turning_dps],
                        stored_offset_dps: self.stored_offset_dps,
                        accel_mps2: [0.0, 0.0, 9.81],
                        temperature_c: Some(temperature_c),
                        ts_us: self.ts_us,
                    },
                    &self.heater,
                );
            }
            *self.calibration.status()
        }
    }

    #[test]
    fn it_waits_for_warmth_then_for_stillness_then_measures_one_second() {
        let mut bench = Bench::new();
        let cold = bench.run(1_000, 30.0, 0.0);
        assert_eq!(cold.state, CalibrationState::WaitingForTemperature);
        assert_eq!(cold.progress, 0.0);

        let turned = bench.run(400, 37.5, 20.0);
        assert_ne!(turned.state, CalibrationState::Done);
        let begun = bench.run(1, 37.5, 0.0);
        assert_eq!(begun.state, CalibrationState::WaitingForStillness);

        let half_way = bench.run(100, 37.5, 0.0);
        assert_eq!(half_way.state, CalibrationState::Measuring);
        assert_eq!(half_way.warmth, TemperatureGateState::AtTarget);
        assert!((half_way.progress - 0.5).abs() < 0.02);

        let done = bench.run(105, 37.5, 0.0);
        assert_eq!(done.state, CalibrationState::Done);
        assert_eq!(done.progress, 1.0);
        let [x, y, z] = bench.calibration.gyro_bias_dps().unwrap();
        assert!((x - 0.5).abs() < 2e-3 && y.abs() < 1e-6 && z.abs() < 1e-6);
    }

    /// The bias changes with temperature, so the first half would not fit the second.
    #[test]
    fn a_second_that_turns_cold_starts_again() {
        let mut bench = Bench::new();
        bench.run(150, 40.0, 0.0);
        let cold = bench.run(1, 36.0, 0.0);
        assert_eq!(cold.state, CalibrationState::WaitingForTemperature);
        assert_eq!(cold.progress, 0.0);
        let again = bench.run(150, 40.0, 0.0);
        assert_eq!(again.state, CalibrationState::Measuring);
    }

    /// A slow, even rotation and a large bias look alike. Only the owner can tell.
    #[test]
    fn an_offset_beyond_two_degrees_a_second_is_refused_unless_it_is_stored() {
        let mut bench = Bench::new();
        assert_ne!(
            bench.run(195, 40.0, 2.1).state,
            CalibrationState::OffsetRefused
        );
        for _ in 0..5 {
            let turning = bench.run(210, 40.0, 2.1);
            assert_eq!(turning.state, CalibrationState::OffsetRefused);
            assert_eq!(bench.calibration.gyro_bias_dps(), None);
        }
        let knocked = bench.run(1, 40.0, 20.0);
        assert_eq!(knocked.state, CalibrationState::WaitingForStillness);
        let still = bench.run(210, 40.0, 1.9);
        assert_eq!(still.state, CalibrationState::Done);

        let mut bench = Bench::new();
        bench.stored_offset_dps = [0.4, 0.0, -4.0];
        assert_eq!(
            bench.run(250, 40.0, 1.9).state,
            CalibrationState::OffsetRefused
        );
        assert_eq!(bench.run(250, 40.0, -5.5).state, CalibrationState::Done);
        let [.., z] = bench.calibration.gyro_bias_dps().unwrap();
        assert!((z + 5.5).abs() < 1e-3);
    }

    #[test]
    fn cold_and_motion_do_not_undo_it() {
        let mut bench = Bench::new();
        bench.run(210, 40.0, 0.0);
        let after = bench.run(500, 20.0, 90.0);
        assert_eq!(after.state, CalibrationState::Done);
        assert_eq!(after.warmth, TemperatureGateState::AtTarget);
    }
}
