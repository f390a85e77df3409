//! One program or erase while it lasts, and the power cut that may end it.

use std::ops::Range;

use robot_plant::{
    flash_chip::{FlashChip, FlashError, Phase, sector_range},
    time::Ps,
};

use super::history::FlashStepKind;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Bits outside `stored` are left alone, and are 1 in `word`.
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
            Self::Erase { sector } => sector_range(sector).map_or(0, |range| range.start),
        }
    }

    pub fn perform(self, chip: &mut FlashChip) -> Result<(), FlashError> {
        match self {
            Self::Program { address, word, .. } => chip.program_word(address, word),
            Self::Erase { sector } => chip.erase(sector),
        }
    }

    /// What a reset or the loss of power in the middle of it leaves.
    pub fn tear(self, chip: &mut FlashChip) {
        chip.cut_at(chip.steps(), Phase::Middle);
        // The cut is what it fails with.
        let _ = self.perform(chip);
        chip.power_up();
    }
}

/// The power goes at a step of the flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedCut {
    /// Counted from 0 at power-on, as in the history.
    pub step: usize,
    pub phase: Phase,
    /// What a torn word or sector looks like.
    pub seed: u64,
}

#[derive(Clone, Debug)]
pub struct UnderWay {
    pub time: Range<Ps>,
    /// None once the cells have it.
    pub work: Option<Work>,
    pub cut: Option<PlannedCut>,
}

impl UnderWay {
    /// When something happens to it.
    pub fn next_event(&self) -> Ps {
        match self.cut.map(|cut| cut.phase) {
            Some(Phase::Middle) => self.time.start + (self.time.end - self.time.start) / 2,
            _ => self.time.end,
        }
    }
}
