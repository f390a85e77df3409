//! Access to the parameter sectors of the flash from outside: contents, wear, defects and power cuts.

use robot_emulator::soc::flash::{CutPhase, PlannedCut};
use robot_plant::flash_chip::{
    EraseFault, FlashChip, PARAMETER_SECTORS, Phase, StuckBit, sector_range,
};

use super::Machine;

pub use robot_emulator::soc::flash::{FlashStep, FlashStepKind, FlashTimes};

/// Bytes in sectors 1–3.
pub const PARAMETER_FLASH_BYTES: usize = 0xC000;
const FIRST: u32 = 0x0800_4000;

impl Machine {
    /// The present contents of sectors 1–3.
    pub fn parameter_flash(&mut self) -> Vec<u8> {
        let mut bytes = vec![0; PARAMETER_FLASH_BYTES];
        self.with_flash(|flash| flash.read(FIRST, &mut bytes))
            .expect("the chip holds these sectors");
        bytes
    }

    /// Sets the contents of sectors 1–3, as if they had been there before power-on.
    pub fn set_parameter_flash(&mut self, bytes: &[u8; PARAMETER_FLASH_BYTES]) {
        self.with_flash(|flash| flash.set_contents(FIRST, bytes))
            .expect("the chip holds these sectors");
    }

    /// Seeds the randomness of the cells from now on.
    pub fn set_flash_seed(&mut self, seed: u64) {
        self.with_flash(|flash| flash.reseed(seed));
    }

    pub fn set_flash_times(&mut self, times: FlashTimes) {
        self.cpu.with_soc(|soc, _| soc.flash_mut().set_times(times));
    }

    /// Programs and erases since power-on, in order; a power cut at step n is one at the n-th of them.
    pub fn flash_steps(&self) -> &[FlashStep] {
        self.cpu.soc().flash().history().steps()
    }

    /// Number of erases that began in sector 1, 2 or 3.
    pub fn flash_erases(&mut self, sector: u8) -> u32 {
        self.with_flash(|flash| flash.erases(sector))
    }

    /// Plans a loss of power at that step. It returns after the time set with [`Machine::set_off_time`].
    pub fn cut_power_at_flash_step(&mut self, step: usize, phase: Phase, seed: u64) {
        let phase = match phase {
            Phase::Before => CutPhase::Before,
            Phase::Middle => CutPhase::Middle,
            Phase::After => CutPhase::After,
        };
        let cut = PlannedCut { step, phase, seed };
        self.cpu.with_soc(|soc, _| soc.flash_mut().plan_cut(cut));
    }

    pub fn stick_flash_bit(&mut self, bit: StuckBit) {
        self.with_flash(|flash| flash.stick(bit));
    }

    pub fn set_flash_erase_fault(&mut self, sector: u8, fault: Option<EraseFault>) {
        self.with_flash(|flash| flash.set_erase_fault(sector, fault));
    }

    /// Makes one bit of every word of sectors 1–3 stick at 1, or repairs all of them.
    pub(super) fn set_worn_words(&mut self, worn: bool) {
        self.with_flash(|flash| {
            if !worn {
                return flash.repair_bits();
            }
            for address in parameter_words() {
                // The stuck bit differs from word to word.
                let bit = (address / 4).wrapping_mul(0x9E37_79B9) >> 27;
                flash.stick(StuckBit {
                    address: address + bit / 8,
                    bit: (bit % 8) as u8,
                    value: true,
                });
            }
        });
    }

    pub(super) fn set_erases_fail(&mut self, fail: bool) {
        for sector in PARAMETER_SECTORS {
            self.set_flash_erase_fault(sector, fail.then_some(EraseFault::DoesNothing));
        }
    }

    fn with_flash<R>(&mut self, f: impl FnOnce(&mut FlashChip) -> R) -> R {
        self.with_board(|board| f(&mut board.flash))
    }
}

fn parameter_words() -> impl Iterator<Item = u32> {
    PARAMETER_SECTORS
        .filter_map(sector_range)
        .flat_map(|sector| sector.step_by(4))
}
