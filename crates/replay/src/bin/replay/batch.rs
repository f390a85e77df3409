//! Runs trials side by side, one on each core.

use std::{
    num::NonZero,
    panic::resume_unwind,
    path::{Path, PathBuf},
    sync::atomic::{AtomicUsize, Ordering},
    thread::{self, ScopedJoinHandle},
};

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
use robot_replay::{At, Trial, run as replay};

use crate::{
    csv,
    outcome::{self, Outcome, Task},
    report,
};

/// Runs all trials and returns their outcomes in the order of `files`. The first error ends the run.
pub fn run(task: &Task, files: &[PathBuf]) -> anyhow::Result<Vec<Outcome>> {
    let bar = ProgressBar::new(files.len() as u64);
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len} trials, {elapsed}")?;
    bar.set_style(style);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some((index, file)) = take(&next, files) {
            done.push((index, run_one(task, file)?));
            bar.inc(1);
        }
        anyhow::Ok(done)
    };
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let done: anyhow::Result<Vec<_>> = thread::scope(|scope| {
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        let joined = workers.into_iter().map(ScopedJoinHandle::join);
        joined
            .map(|done| done.unwrap_or_else(|panic| resume_unwind(panic)))
            .collect()
    });
    bar.finish_and_clear();
    let mut outcomes: Vec<_> = done?.into_iter().flatten().collect();
    outcomes.sort_by_key(|(index, _)| *index);
    Ok(outcomes.into_iter().map(|(_, outcome)| outcome).collect())
}

fn take<'a>(next: &AtomicUsize, files: &'a [PathBuf]) -> Option<(usize, &'a Path)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    Some((index, files.get(index)?))
}

fn run_one(task: &Task, file: &Path) -> anyhow::Result<Outcome> {
    let trial = Trial::read(file)?;
    let run = replay(&trial, task.mode, task.gyro_offset_dps);
    let path = task.out.join(format!("{}.csv", trial.name));
    csv::write(&run, &path).with_context(|| format!("cannot write {}", path.display()))?;
    let bias_rps = run.ticks.last().map_or([0.0; 3], |tick| tick.gyro_bias_rps);
    Ok(Outcome {
        seconds: trial.seconds(),
        rows_without_motion: trial.rows_without_motion,
        rows_without_field: trial.rows_without_field,
        saturated_samples: outcome::saturated_samples(&trial),
        invalid_s: outcome::invalid_s(&run),
        gyro_bias_at_end_dps: bias_rps.map(f32::to_degrees),
        at_samples: run.score(&trial, At::Samples),
        at_1khz: run.score(&trial, At::EveryTick),
        plots: report::plots(&trial, &run, task.gyro_offset_dps)?,
        name: trial.name,
    })
}
