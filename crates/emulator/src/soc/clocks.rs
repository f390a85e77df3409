//! The programmed clock tree and the peripherals that it feeds. RCC writes it, and all blocks read it.

use crate::time::{Ps, SECOND};

/// Frequencies in hertz and the clock-enable registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockTree {
    pub hclk_hz: u32,
    pub pclk1_hz: u32,
    pub pclk2_hz: u32,
    /// Timers on APB1 (TIM2–7, 12–14): twice pclk1 unless APB1 is undivided.
    pub tim1_hz: u32,
    /// Timers on APB2 (TIM1, 8–11).
    pub tim2_hz: u32,
    pub lsi_on: bool,
    pub ahb1enr: u32,
    pub apb1enr: u32,
    pub apb2enr: u32,
}

impl Default for ClockTree {
    /// The state after reset: HSI at 16 MHz, undivided, with flash interface and CCM clocked.
    fn default() -> Self {
        let hsi = 16_000_000;
        Self {
            hclk_hz: hsi,
            pclk1_hz: hsi,
            pclk2_hz: hsi,
            tim1_hz: hsi,
            tim2_hz: hsi,
            lsi_on: false,
            ahb1enr: 0x0010_0000,
            apb1enr: 0,
            apb2enr: 0,
        }
    }
}

/// Duration of `cycles` at `hz`, rounded up.
pub fn cycles_to_ps(cycles: u64, hz: u32) -> Ps {
    (u128::from(cycles) * u128::from(SECOND)).div_ceil(u128::from(hz)) as Ps
}

/// Whole cycles of `hz` that end within `ps`.
pub fn ps_to_cycles(ps: Ps, hz: u32) -> u64 {
    (u128::from(ps) * u128::from(hz) / u128::from(SECOND)) as u64
}
