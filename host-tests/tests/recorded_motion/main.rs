//! The estimator on recorded human motion with optical ground truth (BROAD, see `data/broad/README.md`).
//!
//! The recordings stay outside the repository: in `../shared/data/broad`, or where `ROBOT_DATA` points when this is
//! built. Without them the test counts as ignored.

mod score;
mod trial;

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
    estimation::InsEstimator,
};
use score::{AttitudeError, Rmse};
use trial::Trial;

const SAMPLE_US: u64 = 5_000;
/// The magnetometer is read at 50 Hz.
const ROWS_A_MAG_SAMPLE: usize = 4;
const START_US: u64 = 1_000_000;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Sensors {
    WithMagnetometer,
    WithoutMagnetometer,
}

/// Attitude error of every scored 1 kHz output.
fn run(trial: &Trial, sensors: Sensors) -> Rmse {
    let mut estimator = InsEstimator::new(WheelOdomConfig::default());
    let motor = MotorFeedback::default();
    let mut estimate = StateEstimate::default();
    let mut mag = MagState::default();
    let mut rmse = Rmse::default();
    for (index, row) in trial.rows.iter().enumerate() {
        let ts_us = START_US + index as u64 * SAMPLE_US;
        let imu = ImuState {
            accel_mps2: row.accel_mps2,
            gyro_dps: row.gyro_rps.map(f32::to_degrees),
            ts_us,
            ..ImuState::default()
        };
        if sensors == Sensors::WithMagnetometer && index % ROWS_A_MAG_SAMPLE == 0 {
            mag = MagState {
                mag_ut: row.mag_ut,
                ts_us,
            };
        }
        for step in 0..5 {
            estimator.step(&imu, &mag, &motor, ts_us + step * 1_000, &mut estimate);
            let share = step as f64 / 5.0;
            if let Some(reference) = trial.scored_reference(index, share) {
                rmse.add(AttitudeError::between(
                    estimate.q_wxyz.map(f64::from),
                    reference,
                ));
            }
        }
    }
    rmse
}

/// The mean of the published numbers of VQF with default settings on these trials, extrapolated to 1 kHz: 2.57° total
/// and 0.84° inclination. A single bad trial may be three times as far off.
#[test]
#[cfg_attr(
    not(recorded_motion),
    ignore = "no recorded motion: set ROBOT_DATA to its folder"
)]
fn attitude_follows_the_optical_reference() -> anyhow::Result<()> {
    let trials = trial::load_all()?;
    let (mut total_sum, mut inclination_sum) = (0.0, 0.0);
    println!("trial, RMSE in degrees: total, heading, inclination");
    for trial in &trials {
        let [total, heading, inclination] = run(trial, Sensors::WithMagnetometer).degrees();
        let [_, _, alone] = run(trial, Sensors::WithoutMagnetometer).degrees();
        println!(
            "{:50} {total:8.2} {heading:8.2} {inclination:8.2}",
            trial.name
        );
        assert!(inclination < 3.0, "{}: {inclination}°", trial.name);
        assert!(
            (inclination - alone).abs() < 0.5,
            "{}: the magnetometer tilts the horizon",
            trial.name
        );
        total_sum += total;
        inclination_sum += inclination;
    }
    let count = trials.len() as f64;
    let (total, inclination) = (total_sum / count, inclination_sum / count);
    println!("mean {total:.3}° total, {inclination:.3}° inclination");
    assert!(total < 2.57, "mean error {total}°");
    assert!(inclination < 0.90, "mean inclination error {inclination}°");
    Ok(())
}
