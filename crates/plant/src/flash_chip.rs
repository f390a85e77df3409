//! The flash cells of the STM32F407 (RM0090 3.4–3.6), and the effect of programming, erasing and power cuts on them.
//!
//! Times, keys and registers belong to the flash controller, which is not here: every operation is done at once. Addresses
//! are those of the processor. The tests of the parameter store reach the cells through `embedded_storage`'s `NorFlash`.

mod cells;
mod defects;
mod error;
mod nor_flash;
mod power;
mod sectors;

#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::random::{Random, Stream};
use cells::{Cells, WORD};
use defects::Defects;
use power::{Outcome, Power};
use sectors::{PARAMETER_ADDRESSES, PerSector};

pub use defects::{EraseFault, StuckBit};
pub use error::FlashError;
pub use power::Phase;
pub use sectors::{PARAMETER_SECTORS, sector_range};

/// Contents, wear and defects of sectors 1–3, where the parameters are kept. All random behaviour follows from the seed.
#[derive(Clone, Debug)]
pub struct FlashChip {
    cells: Cells,
    defects: Defects,
    power: Power,
    erases: PerSector<u32>,
    programs: u64,
    random: Random,
}

impl FlashChip {
    /// Erased sectors without a defect.
    pub fn parameters(seed: u64) -> Self {
        Self {
            cells: Cells::blank(PARAMETER_ADDRESSES.len()),
            defects: Defects::default(),
            power: Power::default(),
            erases: PerSector::default(),
            programs: 0,
            random: Random::new(seed, Stream::Flash),
        }
    }

    /// Restarts the random numbers, as in a chip made with `seed`.
    pub fn reseed(&mut self, seed: u64) {
        self.random = Random::new(seed, Stream::Flash);
    }

    /// Puts `bytes` at `address` as if they had been programmed long ago. This does not count as a step and causes no wear.
    ///
    /// # Errors
    /// The range is not in sectors 1–3.
    pub fn set_contents(&mut self, address: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let range = self.range(address, bytes.len())?;
        self.cells.set(range, bytes);
        Ok(())
    }

    /// Reads the cells. An unstable bit reads differently from call to call.
    ///
    /// # Errors
    /// The chip has no power, or the range is not in sectors 1–3.
    pub fn read(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        self.power.check()?;
        let range = self.range(address, bytes.len())?;
        self.cells.read(range, bytes, &mut self.random);
        self.defects.distort(address, bytes);
        Ok(())
    }

    /// Programs a word: bits go from 1 to 0 only. The chip reports no error for a 0 that should become 1.
    ///
    /// # Errors
    /// The chip has no power or loses it, or the address is not that of a word in sectors 1–3.
    pub fn program_word(&mut self, address: u32, value: u32) -> Result<(), FlashError> {
        if !address.is_multiple_of(WORD) {
            return Err(FlashError::NotAligned(address));
        }
        let start = self.range(address, WORD as usize)?.start;
        let outcome = self.power.begin_step()?;
        match outcome {
            Outcome::CutBefore => {}
            Outcome::CutInTheMiddle => self.cells.program_torn(start, value, &mut self.random),
            Outcome::Done | Outcome::CutAfter => self.cells.program(start, value),
        }
        self.programs += u64::from(outcome != Outcome::CutBefore);
        outcome.result()
    }

    /// Erases sector 1, 2 or 3, as far as its defects allow.
    ///
    /// # Errors
    /// The chip has no power or loses it, or it is another sector.
    pub fn erase(&mut self, sector: u8) -> Result<(), FlashError> {
        let addresses = sector_range(sector)
            .filter(|_| PARAMETER_SECTORS.contains(&sector))
            .ok_or(FlashError::OtherSector(sector))?;
        let range = self.range(addresses.start, addresses.len())?;
        let outcome = self.power.begin_step()?;
        match outcome {
            Outcome::CutBefore => {}
            Outcome::CutInTheMiddle => self.cells.erase_torn(range, &mut self.random),
            Outcome::Done | Outcome::CutAfter => match self.defects.erase_fault(sector) {
                None => self.cells.erase(range),
                Some(EraseFault::DoesNothing) => {}
                Some(EraseFault::LeavesSomeWords) => {
                    self.cells.erase_in_part(range, &mut self.random);
                }
            },
        }
        if outcome != Outcome::CutBefore
            && let Some(count) = self.erases.get_mut(sector)
        {
            *count += 1;
        }
        outcome.result()
    }

    /// Number of erases of the sector that were begun. A torn erase counts too, since it wears the sector.
    pub fn erases(&self, sector: u8) -> u32 {
        self.erases.get(sector).unwrap_or_default()
    }

    /// Number of words whose programming was begun.
    pub fn programs(&self) -> u64 {
        self.programs
    }

    /// Number of programs and erases begun since the chip was created, which is also the number of the next step.
    pub fn steps(&self) -> u64 {
        self.power.steps()
    }

    /// Cuts the power at the step of that number, as [`Self::steps`] counts.
    pub fn cut_at(&mut self, step: u64, phase: Phase) {
        self.power.cut_at(step, phase);
    }

    /// False from a power cut until [`Self::power_up`].
    pub fn is_powered(&self) -> bool {
        self.power.check().is_ok()
    }

    /// Restores the power and cancels a cut that has not come yet.
    pub fn power_up(&mut self) {
        self.power = self.power.restored();
    }

    /// Makes a cell stick. From now on it reads the same, whatever is written.
    pub fn stick(&mut self, bit: StuckBit) {
        self.defects.stick(bit);
    }

    /// Frees all stuck cells.
    pub fn repair_bits(&mut self) {
        self.defects.repair_bits();
    }

    /// Makes erases of the sector fail in this way, or work again.
    pub fn set_erase_fault(&mut self, sector: u8, fault: Option<EraseFault>) {
        self.defects.set_erase_fault(sector, fault);
    }

    /// Indices of `length` cells from `address` on.
    fn range(&self, address: u32, length: usize) -> Result<Range<usize>, FlashError> {
        let outside = FlashError::OutOfRange(address);
        let start = address
            .checked_sub(PARAMETER_ADDRESSES.start)
            .ok_or(outside)? as usize;
        if start.saturating_add(length) > PARAMETER_ADDRESSES.len() {
            return Err(outside);
        }
        Ok(start..start + length)
    }
}
