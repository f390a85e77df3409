//! Runs of many robots, on all cores.

use std::{
    num::NonZero,
    ops::Range,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

use crate::{
    Robots,
    limit::Limit,
    tasks::{Bound, Task},
    trial::{Failure, Sample},
};

/// One run of a task.
#[derive(Clone, Debug)]
pub struct Run {
    /// Which robot, in which world.
    pub seed: u64,
    /// The figure of the task, or why there is none.
    pub figure: Result<f64, Failure>,
    /// The figure is within its limit.
    pub ok: bool,
    /// What was seen, each 5 ms.
    pub samples: Vec<Sample>,
}

/// All runs of a task.
#[derive(Clone, Debug)]
pub struct Survey {
    /// In the order of seeds.
    pub runs: Vec<Run>,
    /// What half of the robots survive, where the task has such a figure.
    pub limit: Option<Limit>,
}

enum Job<'a> {
    Run(&'a Task, u64),
    Limit(&'a Task, u64),
}

enum Done {
    Run(Run),
    Limit(f64),
}

/// Runs each task with these robots, and calls `progress` after each part of the work, of which there are
/// [`parts`].
pub fn survey(
    tasks: &[&Task],
    robots: &Robots,
    seeds: Range<u64>,
    limits: bool,
    progress: &(impl Fn() + Sync),
) -> Vec<Survey> {
    let mut jobs = Vec::new();
    for task in tasks {
        jobs.extend(seeds.clone().map(|seed| Job::Run(task, seed)));
        if limits && task.bisection.is_some() {
            jobs.extend(seeds.clone().map(|seed| Job::Limit(task, seed)));
        }
    }
    let mut done = on_all_cores(&jobs, |job| {
        let done = match job {
            Job::Run(task, seed) => Done::Run(run(task, robots, *seed)),
            Job::Limit(task, seed) => Done::Limit(
                task.bisection
                    .map_or(0.0, |bisection| bisection.limit_of(robots, *seed)),
            ),
        };
        progress();
        done
    })
    .into_iter();
    tasks
        .iter()
        .map(|task| {
            let mut survey = Survey {
                runs: Vec::new(),
                limit: None,
            };
            for _ in seeds.clone() {
                if let Some(Done::Run(run)) = done.next() {
                    survey.runs.push(run);
                }
            }
            if let Some(bisection) = task.bisection.filter(|_| limits) {
                let found = seeds.clone().filter_map(|_| match done.next() {
                    Some(Done::Limit(limit)) => Some(limit),
                    _ => None,
                });
                survey.limit = Some(Limit::new(bisection, found.collect()));
            }
            survey
        })
        .collect()
}

/// Number of parts of the work of [`survey`].
pub fn parts(tasks: &[&Task], seeds: u64, limits: bool) -> u64 {
    let each = tasks
        .iter()
        .map(|task| 1 + u64::from(limits && task.bisection.is_some()));
    seeds * each.sum::<u64>()
}

fn run(task: &Task, robots: &Robots, seed: u64) -> Run {
    let finished = (task.run)(robots, seed);
    let ok = match (&finished.figure, task.bound) {
        (Ok(figure), Bound::AtMost) => *figure <= task.limit,
        (Ok(figure), Bound::AtLeast) => *figure >= task.limit,
        (Err(_), _) => false,
    };
    Run {
        seed,
        figure: finished.figure,
        ok,
        samples: finished.trial.kept().to_vec(),
    }
}

/// Results in the order of the jobs.
fn on_all_cores<J: Sync, R: Send>(jobs: &[J], work: impl Fn(&J) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let mut results: Vec<(usize, R)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..cores)
            .map(|_| {
                scope.spawn(|| {
                    let mut results = Vec::new();
                    loop {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some(job) = jobs.get(index) else {
                            return results;
                        };
                        results.push((index, work(job)));
                    }
                })
            })
            .collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().expect("a run panicked"))
            .collect()
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_their_jobs() {
        let jobs: Vec<u64> = (0..100).collect();
        let squares = on_all_cores(&jobs, |job| job * job);
        assert!(
            squares
                .iter()
                .zip(jobs)
                .all(|(square, job)| *square == job * job)
        );
    }
}
