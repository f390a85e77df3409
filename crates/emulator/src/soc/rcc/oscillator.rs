//! The oscillators and the PLL, which become ready some time after they were switched on.

use crate::time::{MS, Ps, US};

use super::registers::{cr, csr};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Oscillator {
    Hsi,
    Hse,
    Pll,
    Lsi,
}

impl Oscillator {
    pub const ALL: [Self; 4] = [Self::Hsi, Self::Hse, Self::Pll, Self::Lsi];

    /// Time from on to ready, datasheet STM32F407 section 5.3.8–5.3.10: typical values, a PLL lock in the middle of its
    /// range.
    pub fn startup(self) -> Ps {
        match self {
            Self::Hsi => 2 * US + US / 5,
            Self::Hse => 2 * MS,
            Self::Pll => 150 * US,
            Self::Lsi => 15 * US,
        }
    }

    /// On and ready bit in the oscillator's register: CSR for the LSI, CR for the others.
    pub fn bits(self) -> (u32, u32) {
        match self {
            Self::Hsi => (cr::HSION, cr::HSIRDY),
            Self::Hse => (cr::HSEON, cr::HSERDY),
            Self::Pll => (cr::PLLON, cr::PLLRDY),
            Self::Lsi => (csr::LSION, csr::LSIRDY),
        }
    }
}
