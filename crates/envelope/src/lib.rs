//! What the balancing robot survives: tasks, each run with many robots that differ from their file.
//!
//! The whole app runs without a chip (`robot-host-loop`) with its estimator and its protocols. The simulated truth judges
//! a run and never steers it.

#![deny(missing_docs)]

mod course;
mod files;
mod limit;
mod plots;
mod report;
mod survey;
mod tasks;
mod trial;

pub use files::write;
pub use limit::Limit;
pub use report::{Report, TaskReport, table};
pub use robot_host_loop::Robots;
pub use survey::{Run, Survey, parts, survey};
pub use tasks::{Bound, TASKS, Task};
pub use trial::{Failure, Sample};
