//! One file a task; `executors.rs` says who preempts whom.

pub mod control;
pub mod imu;
pub mod logic;
pub mod mag;
pub mod params;
pub mod sbus;
pub mod status;
