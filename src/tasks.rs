//! The tasks, one per file. `executors.rs` says which preempts which.

pub mod black_box;
pub mod control;
pub mod imu;
pub mod link_receive;
pub mod link_send;
pub mod logic;
pub mod mag;
pub mod params;
pub mod sbus;
pub mod status;
