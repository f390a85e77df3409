//! One program or erase in progress, and the power cut that may end it.

use std::ops::Range;

use super::{history::FlashStepKind, sectors};
use crate::{soc::flash_cells::FlashCells, time::Ps};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Bits outside `stored` are not changed, and are 1 in `word`.
    Program {
        address: u32,
        word: u32,
        stored: u32,
    },
    Erase {
        sector: u8,
    },
}

impl Work {
    pub fn kind(self) -> FlashStepKind {
        match self {
            Self::Program { .. } => FlashStepKind::Program,
            Self::Erase { .. } => FlashStepKind::Erase,
        }
    }

    pub fn address(self) -> u32 {
        match self {
            Self::Program { address, .. } => address,
            Self::Erase { sector } => sectors::addresses(sector).start,
        }
    }

    pub fn perform(self, cells: &mut dyn FlashCells) {
        match self {
            Self::Program { address, word, .. } => cells.program_word(address, word),
            Self::Erase { sector } => cells.erase(sector),
        }
    }

    /// Changes the cells as a reset or a loss of power in the middle of the operation does.
    pub fn tear(self, cells: &mut dyn FlashCells) {
        match self {
            Self::Program { address, word, .. } => cells.tear_word(address, word),
            Self::Erase { sector } => cells.tear_sector(sector),
        }
    }
}

/// Instant of a power cut within a step of the flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutPhase {
    /// Nothing has happened yet.
    Before,
    /// The word or the sector is torn.
    Middle,
    /// The operation is done, but the image has not seen that.
    After,
}

/// A loss of power at a step of the flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedCut {
    /// Number of the step, counted from 0 at power-on, as in the history.
    pub step: usize,
    /// Instant within the step.
    pub phase: CutPhase,
    /// Seed of the contents of a torn word or sector.
    pub seed: u64,
}

#[derive(Clone, Debug)]
pub struct UnderWay {
    pub time: Range<Ps>,
    /// `None` once it has reached the cells.
    pub work: Option<Work>,
    pub cut: Option<PlannedCut>,
}

impl UnderWay {
    /// When something happens to it.
    pub fn next_event(&self) -> Ps {
        match self.cut.map(|cut| cut.phase) {
            Some(CutPhase::Middle) => self.time.start + (self.time.end - self.time.start) / 2,
            _ => self.time.end,
        }
    }
}
