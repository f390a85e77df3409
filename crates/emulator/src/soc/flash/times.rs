//! Durations of flash operations (STM32F407 datasheet, flash memory programming at 2.7–3.6 V).

use crate::time::{MS, Ps, US};

/// The column of the datasheet that applies to the chip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FlashTimes {
    /// Typical times.
    #[default]
    Typical,
    /// Maximum times.
    Max,
}

/// CR.PSIZE: bits written at once. 64 need a programming voltage that the board does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parallelism {
    X8,
    X16,
    X32,
}

impl Parallelism {
    /// Returns `None` for 64 bits.
    pub fn of(control: u32) -> Option<Self> {
        match control >> 8 & 3 {
            0 => Some(Self::X8),
            1 => Some(Self::X16),
            2 => Some(Self::X32),
            _ => None,
        }
    }

    /// Size in bytes of the only store that programs.
    pub fn bytes(self) -> u8 {
        match self {
            Self::X8 => 1,
            Self::X16 => 2,
            Self::X32 => 4,
        }
    }
}

impl FlashTimes {
    /// Time of one store, whatever its width.
    pub fn program(self) -> Ps {
        match self {
            Self::Typical => 16 * US,
            Self::Max => 100 * US,
        }
    }

    /// Time of erasing a sector of 16 KiB.
    pub fn erase(self, parallelism: Parallelism) -> Ps {
        let typical = match parallelism {
            Parallelism::X8 => 400 * MS,
            Parallelism::X16 => 300 * MS,
            Parallelism::X32 => 250 * MS,
        };
        match self {
            Self::Typical => typical,
            Self::Max => 2 * typical,
        }
    }
}
