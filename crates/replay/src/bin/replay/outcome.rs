//! What is done with each trial, and the outcome.

use std::path::PathBuf;

use robot_chart::Figure;
use robot_replay::{Figures, Mode, Run, Trial};

/// Settings for all trials.
pub struct Task {
    pub mode: Mode,
    pub gyro_offset_dps: [f32; 3],
    pub out: PathBuf,
}

/// The outcome of a trial.
pub struct Outcome {
    pub name: String,
    pub seconds: f64,
    pub rows_without_motion: usize,
    pub rows_without_field: usize,
    /// Samples clipped at the end of the BMI088's range.
    pub saturated_samples: usize,
    /// Time without a valid estimate after the first valid one.
    pub invalid_s: f64,
    pub gyro_bias_at_end_dps: [f32; 3],
    /// Errors against the reference, if there is one.
    pub at_samples: Option<Figures>,
    pub at_1khz: Option<Figures>,
    pub plots: Vec<Figure>,
}

pub fn saturated_samples(trial: &Trial) -> usize {
    let motions = trial.samples.iter().filter_map(|sample| sample.motion);
    motions.filter(|motion| motion.saturated).count()
}

pub fn invalid_s(run: &Run) -> f64 {
    let settled = run.ticks.iter().skip_while(|tick| !tick.valid);
    settled.filter(|tick| !tick.valid).count() as f64 * 1e-3
}
