//! What was found, as in `envelope.json`, and the table in the terminal.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::{
    survey::{Run, Survey},
    tasks::{Bound, Task},
};

/// Failures that are told at most, a task.
const TOLD: usize = 5;

/// Everything that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Name of the robot.
    pub robot: String,
    /// Number of robots that ran each task.
    pub seeds: u64,
    /// By name of the task.
    pub tasks: BTreeMap<&'static str, TaskReport>,
}

/// What was found about one task.
#[derive(Clone, Debug, Serialize)]
pub struct TaskReport {
    /// What is done.
    pub what: &'static str,
    /// Number of runs.
    pub runs: usize,
    /// Those that succeeded.
    pub ok: usize,
    /// Their share.
    pub rate: f64,
    /// The share that is wanted.
    pub wanted: f64,
    /// The figure of each run.
    pub figure: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its limit.
    pub limit: f64,
    /// The worst figure of all runs that have one.
    pub worst: Option<f64>,
    /// The seed with that figure.
    pub worst_seed: Option<u64>,
    /// What half of the robots survive.
    pub limit_50: Option<f64>,
    /// Its unit.
    pub limit_unit: Option<&'static str>,
    /// Why runs failed, by seed; not all of them.
    pub failures: BTreeMap<u64, String>,
}

impl Report {
    /// Sums up the surveys of these tasks.
    pub fn new(robot: &str, seeds: u64, tasks: &[&Task], surveys: &[Survey]) -> Self {
        let each = tasks.iter().zip(surveys);
        Self {
            robot: robot.to_owned(),
            seeds,
            tasks: each
                .map(|(task, survey)| (task.name, TaskReport::new(task, survey)))
                .collect(),
        }
    }

    /// The wanted rates hold.
    pub fn holds(&self) -> bool {
        self.tasks.values().all(TaskReport::holds)
    }
}

impl TaskReport {
    fn new(task: &Task, survey: &Survey) -> Self {
        let runs = survey.runs.len();
        let ok = survey.runs.iter().filter(|run| run.ok).count();
        let worst = worst(task, survey);
        let failures = survey.runs.iter().filter(|run| !run.ok).take(TOLD);
        Self {
            what: task.what,
            runs,
            ok,
            rate: ok as f64 / runs.max(1) as f64,
            wanted: task.wanted,
            figure: task.figure,
            unit: task.unit,
            limit: task.limit,
            worst: worst.and_then(|run| run.figure.as_ref().ok().copied()),
            worst_seed: worst.map(|run| run.seed),
            limit_50: survey.limit.as_ref().map(crate::Limit::median),
            limit_unit: survey.limit.as_ref().map(|limit| limit.unit),
            failures: failures.map(|run| (run.seed, why(task, run))).collect(),
        }
    }

    /// The wanted rate holds.
    pub fn holds(&self) -> bool {
        self.rate >= self.wanted
    }
}

/// The run with the worst figure.
fn worst<'a>(task: &Task, survey: &'a Survey) -> Option<&'a Run> {
    let figure = |run: &Run| run.figure.as_ref().ok().copied();
    let with_figure = survey.runs.iter().filter(|run| run.figure.is_ok());
    let by = |a: &&Run, b: &&Run| match (figure(a), figure(b)) {
        (Some(a), Some(b)) => a.total_cmp(&b),
        _ => std::cmp::Ordering::Equal,
    };
    match task.bound {
        Bound::AtMost => with_figure.max_by(by),
        Bound::AtLeast => with_figure.min_by(by),
    }
}

/// The run to look at: one that failed, or else the worst.
pub(crate) fn most_telling<'a>(task: &Task, survey: &'a Survey) -> Option<&'a Run> {
    let failed = survey.runs.iter().find(|run| run.figure.is_err());
    failed.or_else(|| worst(task, survey))
}

fn why(task: &Task, run: &Run) -> String {
    match &run.figure {
        Ok(figure) => format!("{} {figure:.3} {}", task.figure, task.unit),
        Err(failure) => format!("{:.2} s: {}", failure.at_s, failure.what),
    }
}

/// The table for the terminal.
pub fn table(report: &Report) -> String {
    let mut text = format!(
        "{:<21} {:>9} {:>7} {:>7}  {:<32} {}\n",
        "task", "ok", "rate", "wanted", "worst", "half survive"
    );
    for (name, task) in &report.tasks {
        let worst = match task.worst {
            Some(worst) => format!("{} {worst:.3} {} ({})", task.figure, task.unit, task.limit),
            None => "none ended".to_owned(),
        };
        let limit = match (task.limit_50, task.limit_unit) {
            (Some(limit), Some(unit)) => format!("{limit:.2} {unit}"),
            _ => String::new(),
        };
        let mark = if task.holds() { ' ' } else { '!' };
        text += &format!(
            "{name:<20}{mark} {:>9} {:>6.1}% {:>6.1}%  {worst:<32} {limit}\n",
            format!("{}/{}", task.ok, task.runs),
            100.0 * task.rate,
            100.0 * task.wanted,
        );
        for (seed, why) in &task.failures {
            text += &format!("    seed {seed}: {why}\n");
        }
    }
    text
}
