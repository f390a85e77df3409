//! The table that the terminal shows.

use std::fmt::Write;

use robot_replay::{Figures, Mode};

use crate::outcome::{Outcome, Task};

/// Returns the errors of each trial and their mean, and a line for each trial in which something was missing.
pub fn table(task: &Task, outcomes: &[Outcome]) -> String {
    let name = |outcome: &Outcome| outcome.name.chars().count();
    let width = outcomes.iter().map(name).max().unwrap_or(0).max(18);
    let mut text = format!(
        "RMSE in degrees, {}\n{:width$}   {:^26}   {:^26}\n{:width$}   {HEADS}   {HEADS}\n",
        title(task),
        "",
        "at the samples",
        "at 1 kHz",
        "trial",
    );
    for outcome in outcomes {
        let (samples, ticks) = (cells(outcome.at_samples), cells(outcome.at_1khz));
        let _ = writeln!(text, "{:width$}   {samples}   {ticks}", outcome.name);
    }
    let (samples, ticks) = means(outcomes);
    let label = match outcomes.len() {
        1 => "mean of 1 trial".to_owned(),
        count => format!("mean of {count} trials"),
    };
    let _ = writeln!(
        text,
        "{label:width$}   {}   {}",
        cells(samples),
        cells(ticks)
    );
    for outcome in outcomes {
        text.extend(troubles(outcome).map(|trouble| format!("{}: {trouble}\n", outcome.name)));
    }
    text
}

const HEADS: &str = "   total  heading    incl.";

fn cells(figures: Option<Figures>) -> String {
    match figures {
        Some(Figures {
            total_deg,
            heading_deg,
            inclination_deg,
        }) => format!("{total_deg:8.2} {heading_deg:8.2} {inclination_deg:8.2}"),
        None => format!("{:>26}", "no reference"),
    }
}

/// Returns the mean errors over the trials that have a reference: at the samples and at 1 kHz.
pub fn means(outcomes: &[Outcome]) -> (Option<Figures>, Option<Figures>) {
    let mean = |figures: fn(&Outcome) -> Option<Figures>| {
        let all: Vec<Figures> = outcomes.iter().filter_map(figures).collect();
        Figures::mean(&all)
    };
    (
        mean(|outcome| outcome.at_samples),
        mean(|outcome| outcome.at_1khz),
    )
}

/// Describes what was replayed.
pub fn title(task: &Task) -> String {
    let mode = match task.mode {
        Mode::NineAxis => "with magnetometer (9d)",
        Mode::SixAxis => "without magnetometer (6d)",
    };
    match task.gyro_offset_dps {
        [0.0, 0.0, 0.0] => mode.to_owned(),
        [x, y, z] => format!("{mode}, gyro offset by {x}, {y}, {z} °/s"),
    }
}

/// Describes the samples that the estimator did not get.
pub fn troubles(outcome: &Outcome) -> impl Iterator<Item = String> {
    let rows = |count: usize, sensor: &str| {
        (count > 0).then(|| format!("{count} rows without {sensor} numbers, dropped"))
    };
    let invalid = outcome.invalid_s;
    [
        rows(outcome.rows_without_motion, "IMU"),
        rows(outcome.rows_without_field, "magnetometer"),
        (outcome.saturated_samples > 0).then(|| {
            let count = outcome.saturated_samples;
            format!("{count} samples cut off at the end of the BMI088's range")
        }),
        (invalid > 0.0).then(|| format!("the estimate was invalid for {invalid:.3} s")),
    ]
    .into_iter()
    .flatten()
}
