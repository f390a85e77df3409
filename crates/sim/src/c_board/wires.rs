//! Conversions between the frames, characters and flash cells of the chip and those of the world.

use robot_emulator::{
    soc::flash_cells::FlashCells,
    wire::{self as chip, CanPort},
};
use robot_plant::{
    flash_chip::{FlashChip, FlashError, Phase},
    wire as plant,
    world::CanBusId,
};

use super::CBoard;

pub(super) fn bus_id(port: CanPort) -> CanBusId {
    match port {
        CanPort::Can1 => CanBusId::Can1,
        CanPort::Can2 => CanBusId::Can2,
    }
}

pub(super) fn chip_frame(frame: plant::CanFrame) -> chip::CanFrame {
    chip::CanFrame {
        id: frame.id,
        extended: frame.extended,
        remote: frame.remote,
        dlc: frame.dlc,
        data: frame.data,
    }
}

pub(super) fn board_frame(frame: chip::CanFrame) -> plant::CanFrame {
    plant::CanFrame {
        id: frame.id,
        extended: frame.extended,
        remote: frame.remote,
        dlc: frame.dlc,
        data: frame.data,
    }
}

pub(super) fn chip_character(character: plant::UartChar) -> chip::UartChar {
    let format = character.format;
    chip::UartChar {
        start: character.start,
        byte: character.byte,
        format: chip::LineFormat {
            baud: format.baud,
            data_bits: format.data_bits,
            parity: match format.parity {
                plant::Parity::None => chip::Parity::None,
                plant::Parity::Even => chip::Parity::Even,
                plant::Parity::Odd => chip::Parity::Odd,
            },
            stop_bits: format.stop_bits,
        },
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
