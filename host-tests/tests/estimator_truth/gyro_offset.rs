//! The gyro's offset: large at start-up, wandering later, taken out elsewhere, and real turns that look like one.

mod balancing;
mod calibrated;
mod slow_turn;
mod start_up;
mod wandering;
