//! Mahony's filter of the crate `uf-ahrs`, with its own settings.

#![no_std]
#![no_main]

use core::time::Duration;

use robot_estimator_bench::{board, uf_ahrs::AllInOne};
use uf_ahrs::{Mahony, MahonyParams};

#[cortex_m_rt::entry]
fn main() -> ! {
    let filter = Mahony::new(Duration::from_millis(5), MahonyParams::default());
    board::run(AllInOne::new(filter))
}
