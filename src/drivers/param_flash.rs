//! Sectors 1 to 3 of the internal flash, where the parameter store lives (RM0090 section 3).

use embassy_stm32::flash::{Bank1Region1, Blocking, Error, Flash};
use embassy_stm32::pac::flash::vals::Psize;
use embassy_stm32::pac::{FLASH, PWR};
use embassy_stm32::{Peri, peripherals};
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

use crate::stall;

/// Sector 0 holds the vector table; offsets here count from sector 1, so it cannot be reached.
const SECTOR_1: u32 = 0x4000;
/// Sector 4, where the code begins, cannot be reached either.
const CAPACITY: u32 = 3 * 0x4000;

/// The unlock sequence (RM0090 3.9.2).
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

/// Why flash was not read, written or erased.
#[derive(Clone, Copy, Debug, defmt::Format)]
pub enum FlashError {
    /// An error of the flash controller or the HAL.
    Chip(Error),
    /// The supply is too low to program 32 bits at a time.
    SupplyLow,
    /// The clock could not be corrected after an erase.
    ClockUnkept,
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::Chip(error) => error.kind(),
            Self::SupplyLow | Self::ClockUnkept => NorFlashErrorKind::Other,
        }
    }
}

/// The parameter sectors. While a word is programmed or a sector erased, the CPU stands still, because its code is in flash
/// too.
pub struct ParamFlash(Bank1Region1<'static, Blocking>);

impl ParamFlash {
    pub fn new(flash: Peri<'static, peripherals::FLASH>) -> Self {
        let regions = Flash::new_blocking(flash).into_blocking_regions();
        Self(regions.bank1_region1)
    }
}

impl ErrorType for ParamFlash {
    type Error = FlashError;
}

impl ReadNorFlash for ParamFlash {
    const READ_SIZE: usize = 1;

    #[inline(never)]
    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let from = place(offset, bytes.len())?;
        self.0.blocking_read(from, bytes).map_err(FlashError::Chip)
    }

    fn capacity(&self) -> usize {
        CAPACITY as usize
    }
}

impl NorFlash for ParamFlash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 0x4000;

    /// Programs word by word; interrupts run in between.
    #[inline(never)]
    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let from = place(offset, bytes.len())?;
        need_supply()?;
        let result = self.0.blocking_write(from, bytes);
        forget_cached_data();
        result.map_err(failed)
    }

    #[inline(never)]
    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let len = to.checked_sub(from).ok_or(FlashError::Chip(Error::Size))?;
        let from = place(from, len as usize)?;
        let to = from.saturating_add(len);
        need_supply()?;
        let result = stall::stand_still(|| {
            use_full_width();
            let result = self.0.blocking_erase(from, to);
            forget_cached_data();
            result
        });
        match result {
            Some(result) => result.map_err(failed),
            None => Err(refused(FlashError::ClockUnkept)),
        }
    }
}

/// The detector's level is 2.9 V (`board.rs`); 2.7 V is the least for 32 bits at a time (RM0090 table 11).
fn need_supply() -> Result<(), FlashError> {
    if PWR.csr1().read().pvdo() {
        return Err(refused(FlashError::SupplyLow));
    }
    Ok(())
}

fn failed(error: Error) -> FlashError {
    refused(FlashError::Chip(error))
}

#[cold]
#[inline(never)]
fn refused(error: FlashError) -> FlashError {
    defmt::error!("settings flash: {}", error);
    error
}

/// Where `len` bytes at `offset` lie from the start of flash.
fn place(offset: u32, len: usize) -> Result<u32, FlashError> {
    let end = u32::try_from(len)
        .ok()
        .and_then(|len| offset.checked_add(len));
    if end.is_none_or(|end| end > CAPACITY) {
        return Err(FlashError::Chip(Error::Size));
    }
    Ok(offset.saturating_add(SECTOR_1))
}

/// Sets the width to 32 bits, which halves the time of an erase. The HAL does not set it before it erases, and leaves it at
/// 8 bits after it has written.
fn use_full_width() {
    if FLASH.cr().read().lock() {
        for key in KEYS {
            FLASH.keyr().write_value(key);
        }
    }
    FLASH.cr().modify(|w| w.set_psize(Psize::PSIZE32));
}

/// Clears the data cache, which does not notice changes of the cells (RM0090 3.5.4). It can only be reset while it is off.
fn forget_cached_data() {
    FLASH.acr().modify(|w| w.set_dcen(false));
    FLASH.acr().modify(|w| w.set_dcrst(true));
    FLASH.acr().modify(|w| w.set_dcrst(false));
    FLASH.acr().modify(|w| w.set_dcen(true));
}
