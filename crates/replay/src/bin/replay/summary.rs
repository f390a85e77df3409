//! `summary.json`: the figures for scripts.

use std::path::Path;

use robot_replay::{Figures, Mode};
use serde::Serialize;

use crate::{
    outcome::{Outcome, Task},
    table,
};

#[derive(Serialize)]
struct Summary<'a> {
    data: &'a Path,
    mode: Mode,
    gyro_offset_dps: [f32; 3],
    mean: Errors,
    trials: Vec<TrialSummary<'a>>,
}

/// RMSE over the scored phase; null without reference.
#[derive(Serialize)]
struct Errors {
    at_samples: Option<Figures>,
    at_1khz: Option<Figures>,
}

#[derive(Serialize)]
struct TrialSummary<'a> {
    trial: &'a str,
    seconds: f64,
    #[serde(flatten)]
    errors: Errors,
    gyro_bias_at_end_dps: [f32; 3],
    rows_without_motion: usize,
    rows_without_field: usize,
    saturated_samples: usize,
    /// Time without a valid estimate after the first valid one.
    invalid_s: f64,
}

pub fn json(task: &Task, data: &Path, outcomes: &[Outcome]) -> serde_json::Result<String> {
    let (at_samples, at_1khz) = table::means(outcomes);
    let summary = Summary {
        data,
        mode: task.mode,
        gyro_offset_dps: task.gyro_offset_dps,
        mean: Errors {
            at_samples,
            at_1khz,
        },
        trials: outcomes.iter().map(of_trial).collect(),
    };
    serde_json::to_string_pretty(&summary)
}

fn of_trial(outcome: &Outcome) -> TrialSummary<'_> {
    TrialSummary {
        trial: &outcome.name,
        seconds: outcome.seconds,
        errors: Errors {
            at_samples: outcome.at_samples,
            at_1khz: outcome.at_1khz,
        },
        gyro_bias_at_end_dps: outcome.gyro_bias_at_end_dps,
        rows_without_motion: outcome.rows_without_motion,
        rows_without_field: outcome.rows_without_field,
        saturated_samples: outcome.saturated_samples,
        invalid_s: outcome.invalid_s,
    }
}
