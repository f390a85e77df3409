//! The gyro's offset: large at start-up, wandering later, and real turns that look like one.

mod slow_turn;
mod start_up;
mod wandering;
