//! The chip's CAN controllers and flash cells as those of the world.

use robot_emulator::{soc::flash_cells::FlashCells, wire::CanPort};
use robot_plant::{
    flash_chip::{FlashChip, FlashError, Phase},
    world::CanBusId,
};

use super::CBoard;

pub(super) fn bus_id(port: CanPort) -> CanBusId {
    match port {
        CanPort::Can1 => CanBusId::Can1,
        CanPort::Can2 => CanBusId::Can2,
    }
}

const POWERED: &str = "a word or a sector of the powered chip";

impl FlashCells for CBoard {
    fn read_word(&mut self, address: u32) -> u32 {
        let mut bytes = [0; 4];
        self.flash.read(address, &mut bytes).expect(POWERED);
        u32::from_le_bytes(bytes)
    }

    fn program_word(&mut self, address: u32, word: u32) {
        self.flash.program_word(address, word).expect(POWERED);
    }

    fn erase(&mut self, sector: u8) {
        self.flash.erase(sector).expect(POWERED);
    }

    fn tear_word(&mut self, address: u32, word: u32) {
        tear(&mut self.flash, |flash| flash.program_word(address, word));
    }

    fn tear_sector(&mut self, sector: u8) {
        tear(&mut self.flash, |flash| flash.erase(sector));
    }

    fn reseed(&mut self, seed: u64) {
        self.flash.reseed(seed);
    }
}

fn tear(flash: &mut FlashChip, step: impl FnOnce(&mut FlashChip) -> Result<(), FlashError>) {
    flash.cut_at(flash.steps(), Phase::Middle);
    // The only error here is the power cut.
    let _ = step(flash);
    flash.power_up();
}
