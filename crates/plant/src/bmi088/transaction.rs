//! The bytes that are exchanged while one chip select is low.

use super::die::Die;
use crate::time::Ps;

/// State of one chip select, and the bytes exchanged since it fell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Transaction {
    pub selected: bool,
    since: Ps,
    bytes: usize,
    address: u8,
}

impl Transaction {
    /// Changes the level of the chip select at `now`. `selected` means low.
    pub(super) fn begin(selected: bool, now: Ps) -> Self {
        Self {
            selected,
            since: now,
            ..Self::default()
        }
    }

    pub(super) fn exchange<D: Die>(&mut self, die: &mut D, mosi: u8, now: Ps) -> u8 {
        const READ: u8 = 0x80;
        let index = self.bytes;
        self.bytes += 1;
        if index == 0 {
            self.address = mosi;
            return 0xFF;
        }
        let register = self.address & !READ;
        if self.address & READ == 0 {
            // The datasheet specifies single-byte writes only.
            if index == 1 {
                die.write(register, mosi, self.since, now);
            }
            return 0xFF;
        }
        match index.checked_sub(1 + D::DUMMY_BYTES) {
            Some(_) if register == D::FIFO_DATA && die.drives_miso() => die.read(register, now),
            Some(offset) if die.drives_miso() => {
                die.read(register.wrapping_add(offset as u8) & 0x7F, now)
            }
            _ => 0xFF,
        }
    }
}
