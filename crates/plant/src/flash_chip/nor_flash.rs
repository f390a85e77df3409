//! Sectors 1–3 with offsets from the start of sector 1, as the parameter store uses them.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash, check_erase, check_read,
    check_write,
};

use super::{FlashChip, FlashError, PARAMETER_SECTORS, cells::WORD, sectors::PARAMETER_ADDRESSES};

const SECTOR: u32 = 16 * 1024;
const CAPACITY: u32 = PARAMETER_ADDRESSES.end - PARAMETER_ADDRESSES.start;

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::PowerLost => NorFlashErrorKind::Other,
            Self::NotAligned(_) => NorFlashErrorKind::NotAligned,
            Self::OutOfRange(_) | Self::OtherSector(_) => NorFlashErrorKind::OutOfBounds,
        }
    }
}

impl ErrorType for FlashChip {
    type Error = FlashError;
}

impl ReadNorFlash for FlashChip {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        check_read(self, offset, bytes.len()).map_err(|kind| error(kind, offset))?;
        FlashChip::read(self, address(offset), bytes)
    }

    fn capacity(&self) -> usize {
        CAPACITY as usize
    }
}

impl NorFlash for FlashChip {
    const WRITE_SIZE: usize = WORD as usize;
    const ERASE_SIZE: usize = SECTOR as usize;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        check_erase(self, from, to).map_err(|kind| error(kind, from))?;
        PARAMETER_SECTORS
            .zip((0..CAPACITY).step_by(Self::ERASE_SIZE))
            .filter(|(_, offset)| (from..to).contains(offset))
            .try_for_each(|(sector, _)| FlashChip::erase(self, sector))
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        check_write(self, offset, bytes.len()).map_err(|kind| error(kind, offset))?;
        let words = bytes.as_chunks().0.iter().copied().map(u32::from_le_bytes);
        (address(offset)..)
            .step_by(Self::WRITE_SIZE)
            .zip(words)
            .try_for_each(|(address, word)| self.program_word(address, word))
    }
}

fn address(offset: u32) -> u32 {
    PARAMETER_ADDRESSES.start.saturating_add(offset)
}

fn error(kind: NorFlashErrorKind, offset: u32) -> FlashError {
    match kind {
        NorFlashErrorKind::NotAligned => FlashError::NotAligned(address(offset)),
        _ => FlashError::OutOfRange(address(offset)),
    }
}
