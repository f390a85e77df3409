//! Runs everything that is measured, on every core, behind one progress bar.

use std::{
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    thread,
};

use anyhow::Context;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use robot_sim::{scenario::Scenario, summary::Summary};

use crate::{
    filters::{EMPTY, Filter, OURS, PUBLISHED_FILTERS},
    measure::{self, Detail, Measured},
    motion::{Motion, TICKS_A_SAMPLE, Wheels},
    program::Program,
    scenarios,
};

/// What to measure: the image on the board, and the filters over motions.
pub struct Plan {
    /// `None` if the board is not measured.
    pub board: Option<Board>,
    /// Folder of the filters' programs.
    pub programs: PathBuf,
    pub motions: Vec<Motion>,
    pub detail: Detail,
}

pub struct Board {
    /// The shipped image.
    pub image: PathBuf,
    pub scenarios: Vec<Scenario>,
}

/// A filter on one kind of motion. It is a column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub filter: Filter,
    pub wheels: Wheels,
}

/// What an entry cost over each of its motions, in their order.
pub struct FilterResult {
    pub entry: Entry,
    /// Start-up and mailbox do not count.
    pub flash_bytes: usize,
    pub runs: Vec<Measured>,
}

pub struct Results {
    /// Summaries of the scenarios, in the order of the plan.
    pub boards: Vec<Summary>,
    pub filters: Vec<FilterResult>,
}

enum Task<'p> {
    Board(&'p Path, &'p Scenario),
    Filter(Entry, &'p Motion),
}

enum TaskResult {
    Board(Box<Summary>),
    Filter(Entry, Box<Measured>),
}

impl Plan {
    pub fn run(&self) -> anyhow::Result<Results> {
        let empty = Program::boot(&EMPTY.elf(&self.programs))?.flash_bytes;
        let tasks = self.tasks();
        let bar = bar(tasks.iter().map(Task::milliseconds).sum());
        let done = self.do_all(tasks, &bar);
        bar.finish_and_clear();
        let (mut boards, mut measured) = (Vec::new(), Vec::new());
        for done in done? {
            match done {
                TaskResult::Board(summary) => boards.push(*summary),
                TaskResult::Filter(entry, run) => measured.push((entry, *run)),
            }
        }
        let mut filters = Vec::new();
        for entry in entries() {
            let own = measured.extract_if(.., |(of, _)| *of == entry);
            let runs: Vec<Measured> = own.map(|(_, run)| run).collect();
            let flash_bytes = runs.first().context("no motion to run")?.flash_bytes;
            filters.push(FilterResult {
                entry,
                flash_bytes: flash_bytes.saturating_sub(empty),
                runs,
            });
        }
        Ok(Results { boards, filters })
    }

    /// Returns all tasks, the longest first, so that no core works alone on a long one at the end.
    fn tasks(&self) -> Vec<Task<'_>> {
        let boards = self.board.iter().flat_map(|board| {
            let scenarios = board.scenarios.iter();
            scenarios.map(|scenario| Task::Board(&board.image, scenario))
        });
        let filters = entries().flat_map(|entry| {
            let own = self
                .motions
                .iter()
                .filter(move |motion| motion.wheels() == entry.wheels);
            own.map(move |motion| Task::Filter(entry, motion))
        });
        boards.chain(filters).collect()
    }

    /// Runs the tasks and returns their results in the same order.
    fn do_all(&self, tasks: Vec<Task<'_>>, bar: &ProgressBar) -> anyhow::Result<Vec<TaskResult>> {
        let count = tasks.len();
        let queue = Mutex::new(tasks.into_iter().enumerate());
        let done = Mutex::new(Vec::with_capacity(count));
        let take = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
        let put = |place, outcome: anyhow::Result<TaskResult>| {
            let failed = outcome.is_err();
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            done.push((place, outcome));
            failed
        };
        let cores = thread::available_parallelism().map_or(1, usize::from);
        thread::scope(|scope| {
            for _ in 0..cores.min(count) {
                scope.spawn(|| {
                    while let Some((place, task)) = take() {
                        if put(place, self.do_one(&task, bar)) {
                            while take().is_some() {}
                        }
                    }
                });
            }
        });
        let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        done.sort_by_key(|(place, _)| *place);
        done.into_iter().map(|(_, outcome)| outcome).collect()
    }

    fn do_one(&self, task: &Task<'_>, bar: &ProgressBar) -> anyhow::Result<TaskResult> {
        match task {
            Task::Board(image, scenario) => {
                bar.set_message(scenario.name.clone());
                let summary = scenarios::run(image, (*scenario).clone(), || bar.inc(1))?;
                Ok(TaskResult::Board(Box::new(summary)))
            }
            Task::Filter(entry, motion) => {
                let Entry { filter, .. } = *entry;
                bar.set_message(format!("{}: {}", filter.title, motion.name()));
                measure::run(filter, &self.programs, motion, self.detail, || bar.inc(1))
                    .with_context(|| format!("{} over {}", filter.title, motion.name()))
                    .map(|run| TaskResult::Filter(*entry, Box::new(run)))
            }
        }
    }
}

impl Task<'_> {
    /// Returns how much simulated time the task takes.
    fn milliseconds(&self) -> u64 {
        match self {
            Self::Board(_, scenario) => scenarios::length_ms(scenario),
            Self::Filter(_, motion) => motion.samples().len() as u64 * TICKS_A_SAMPLE,
        }
    }
}

/// Returns our estimator and the other filters over the recordings, then ours over a motion with wheels, which no
/// recording has.
fn entries() -> impl Iterator<Item = Entry> {
    let of = |wheels| move |filter| Entry { filter, wheels };
    let silent = [OURS]
        .into_iter()
        .chain(PUBLISHED_FILTERS)
        .map(of(Wheels::Silent));
    silent.chain([OURS].map(of(Wheels::Turning)))
}

impl Entry {
    pub fn title(self) -> &'static str {
        match self.wheels {
            Wheels::Silent => self.filter.title,
            Wheels::Turning => "robot, wheels",
        }
    }

    /// True for the entries that the limits of the estimator apply to.
    pub fn is_ours(self) -> bool {
        self.filter == OURS
    }
}

fn bar(length: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr_with_hz(10));
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta:>4} left  {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
