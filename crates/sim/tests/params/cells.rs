//! Independent runs on all cores.

use std::{
    sync::{Mutex, PoisonError},
    thread,
};

/// The results of `run` for each cell, in the order of the cells.
pub fn run_all<C: Sync, R: Send>(cells: &[C], run: impl Fn(&C) -> R + Sync) -> Vec<R> {
    let queue = Mutex::new(cells.iter().enumerate());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = || {
        let mut done = Vec::new();
        while let Some((place, cell)) = next() {
            done.push((place, run(cell)));
        }
        done
    };
    let cores = thread::available_parallelism().map_or(1, |n| n.get());
    let mut done: Vec<(usize, R)> = thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        joined
            .flat_map(|done| done.expect("no run failed"))
            .collect()
    });
    done.sort_by_key(|(place, _)| *place);
    done.into_iter().map(|(_, result)| result).collect()
}
