//! Common parts of both dies of the BMI088.

use crate::{
    physics::PHYSICS_STEP,
    time::{Ps, SECOND},
};

/// Value that restarts the die when written to its SOFTRESET register.
pub(super) const SOFTRESET: u8 = 0xB6;
/// "Data ready" in the status register of either die.
pub(super) const DATA_READY: u8 = 1 << 7;

/// The registers of one die as its SPI bus sees them.
pub(super) trait Die {
    /// Bytes between the address and the first data byte of a read.
    const DUMMY_BYTES: usize;
    /// A burst reads this register again and again; after any other register it reads the next.
    const FIFO_DATA: u8;
    fn read(&mut self, register: u8, now: Ps) -> u8;
    /// Notes that the chip select is low since `selected_at`.
    fn write(&mut self, register: u8, value: u8, selected_at: Ps, now: Ps);
    /// Notes that the chip select rises.
    fn deselected(&mut self, now: Ps);
    /// False while the die leaves MISO to the pull-up.
    fn drives_miso(&self) -> bool;
}

/// Rate at which the analogue chains advance, Hz.
pub(super) fn rate_of_steps_hz() -> f64 {
    SECOND as f64 / PHYSICS_STEP as f64
}

/// Rounds to the nearest code and clips to the range of an `i16`, as the converter does.
pub(super) fn quantise(counts: f64) -> i16 {
    counts.round() as i16
}
