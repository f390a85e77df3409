//! The gyro bias: large at start-up, wandering later, removed by a calibration; and rotations that look like one.

mod balancing;
mod calibrated;
mod slow_turn;
mod start_up;
mod wandering;
