//! The independent watchdog: resets the chip when the control tick stops feeding it.

use embassy_stm32::Peri;
use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;

/// Nominal period. Its clock, the LSI, runs at 17 to 47 kHz (STM32F407 datasheet table 35; nominal 32 kHz), so the
/// real period is 12 to 34 ms. Together with the deadlines of `deadlines.rs` (25 ms) any hang ends in a reset
/// within 60 ms.
const PERIOD_US: u32 = 18_000;

pub struct Watchdog(IndependentWatchdog<'static, IWDG>);

impl Watchdog {
    /// Starts the watchdog; nothing but a reset can stop it.
    pub fn start(iwdg: Peri<'static, IWDG>) -> Self {
        let mut watchdog = IndependentWatchdog::new(iwdg, PERIOD_US);
        watchdog.unleash();
        Self(watchdog)
    }

    pub fn feed(&mut self) {
        self.0.pet();
    }
}
