//! All limits of the estimator's errors on the twelve trials.

use robot_replay::Figures;

use crate::twelve_trials::Errors;

/// Means over the trials.
pub struct Limits {
    /// Total error at the times of the reference.
    total_at_samples_deg: f64,
    /// Total error over all outputs.
    total_every_tick_deg: f64,
    inclination_deg: f64,
}

/// VQF with default settings: 2.56°, extrapolated to 1 kHz 2.57°; inclination 0.84°.
pub const WITH_MAGNETOMETER: Limits = Limits {
    total_at_samples_deg: 2.30,
    total_every_tick_deg: 2.32,
    inclination_deg: 0.75,
};

/// VQF with default settings: 5.60°, inclination 0.84°.
pub const WITHOUT_MAGNETOMETER: Limits = Limits {
    total_at_samples_deg: 5.0,
    total_every_tick_deg: 5.0,
    inclination_deg: 0.75,
};

/// The limit for a single trial.
pub const WORST_INCLINATION_DEG: f64 = 3.0;
/// The most by which the magnetometer may change the inclination.
pub const TILT_BY_MAGNETOMETER_DEG: f64 = 0.5;

/// Biases of 4.4 °/s that are added to every gyro sample of every trial, on top of the sensors' own biases.
pub const START_UP_OFFSETS_DPS: [[f32; 3]; 3] =
    [[2.54, -2.54, 2.54], [4.4, 0.0, 0.0], [0.0, -4.4, 0.0]];
/// The most by which such a bias may increase any figure.
pub const WORSE_BY_OFFSET_DEG: f64 = 0.3;

impl Limits {
    pub fn hold(&self, errors: &Errors) {
        let (samples, ticks) = (errors.mean_at_samples(), errors.mean_every_tick());
        for (what, figure, limit) in [
            (
                "total at the samples",
                samples.total_deg,
                self.total_at_samples_deg,
            ),
            (
                "total at every tick",
                ticks.total_deg,
                self.total_every_tick_deg,
            ),
            (
                "inclination at the samples",
                samples.inclination_deg,
                self.inclination_deg,
            ),
        ] {
            assert!(figure <= limit, "{what}: {figure:.3}°, limit {limit}°");
        }
    }
}

/// The largest increase of a figure.
pub fn worse_deg(figures: &Figures, before: &Figures) -> f64 {
    let growth = [
        figures.total_deg - before.total_deg,
        figures.heading_deg - before.heading_deg,
        figures.inclination_deg - before.inclination_deg,
    ];
    growth.into_iter().fold(f64::NEG_INFINITY, f64::max)
}
