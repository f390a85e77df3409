//! The black box: the last seconds around every stop that nobody asked for (docs/black-box.md).
//!
//! It lives in RAM that survives a reset, in two banks. One records; the other may hold an event. A bank is a header and
//! two rings of records: a fine one with the newest, and a coarse one with every fifth of those that the fine ring
//! overwrites.

mod balance_sample;
mod bank;
mod fixed_point;
mod header;
mod memory;
mod recorder;
mod sample;
mod trigger;

pub use balance_sample::BalanceSample;
pub use bank::{Bank, SAMPLES_A_BANK};
pub use header::Event;
pub use memory::{BANK_BYTES, BANK_COUNT, BlackBoxMemory, LAYOUT_VERSION, LAYOUTS};
pub use recorder::BlackBox;
pub use sample::{BlackBoxSample, CommandSource};
