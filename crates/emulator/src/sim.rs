//! Scenarios on the emulated board: run, judge, record, report.

pub mod attitude_score;
pub mod board;
pub mod budgets;
pub mod expectation;
pub mod faults;
pub mod job;
mod recording;
mod report;
pub mod run_signals;
pub mod runner;
pub mod scenario;
pub mod signals;
pub mod summary;
pub mod terminal;
mod trace;
mod tree;
