//! The estimator on simulated motion whose truth is known exactly.
//!
//! `world` integrates body rates in double precision at 4 kHz and measures the result as the sensors do. Each case
//! states what physics lets a good filter reach. `--nocapture` prints the figures.

mod error;
mod figures;
mod garbage;
mod gyro_offset;
mod hidden_errors;
mod lasting_acceleration;
mod magnets;
mod motion;
mod random_states;
mod run;
mod sample_faults;
mod sensors;
mod time;
mod turning;
mod valid;
mod world;
