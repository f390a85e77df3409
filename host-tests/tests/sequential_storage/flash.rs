//! Adapts a blocking flash to the crate's async traits.

use std::{
    future::Future,
    pin::pin,
    task::{Context, Poll, Waker},
};

use embedded_storage_async::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use robot_plant::flash_chip::{FlashChip, FlashError};

/// Sectors 1–3 of the chip's model.
pub struct Chip<'a>(pub &'a mut FlashChip);

impl ErrorType for Chip<'_> {
    type Error = FlashError;
}

impl ReadNorFlash for Chip<'_> {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        embedded_storage::nor_flash::ReadNorFlash::read(self.0, offset, bytes)
    }

    fn capacity(&self) -> usize {
        0xC000
    }
}

impl NorFlash for Chip<'_> {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 0x4000;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        embedded_storage::nor_flash::NorFlash::erase(self.0, from, to)
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        embedded_storage::nor_flash::NorFlash::write(self.0, offset, bytes)
    }
}

/// Result of a future that never waits.
pub fn block_on<T>(future: impl Future<Output = T>) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => unreachable!("a blocking flash never waits"),
    }
}

pub fn erases(chip: &FlashChip) -> u32 {
    (1..=3).map(|sector| chip.erases(sector)).sum()
}
