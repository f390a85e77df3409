//! Madgwick's filter of the crate `uf-ahrs`, with its own settings.

#![no_std]
#![no_main]

use core::time::Duration;

use robot_estimator_bench::{board, uf_ahrs::AllInOne};
use uf_ahrs::{Madgwick, MadgwickParams};

#[cortex_m_rt::entry]
fn main() -> ! {
    let filter = Madgwick::new(Duration::from_millis(5), MadgwickParams::default());
    board::run(AllInOne::new(filter))
}
