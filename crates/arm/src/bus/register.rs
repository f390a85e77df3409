//! The memory table of an STS3215, so that nobody writes an address by hand.
//!
//! Source: the STS3215 memory table, LeRobot's feetech tables and the manufacturer's SDK.

mod table;

pub use table::*;

use std::{fmt, ops::RangeInclusive};

/// Where a value lives in a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// It survives without power. A write takes a lock of zero and torque off.
    Eeprom,
    /// It is back to its default after a power cycle.
    Ram,
    /// The servo alone writes it.
    ReadOnly,
}

/// How a value is put into its bytes, the low byte first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Unsigned,
    /// The bit of this number says that the value is negative; the bits below it are the magnitude.
    SignMagnitude(u8),
}

/// One value in the memory of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    name: &'static str,
    address: u8,
    size: u8,
    encoding: Encoding,
    memory: Memory,
}

impl Register {
    const fn new(
        name: &'static str,
        address: u8,
        size: u8,
        encoding: Encoding,
        memory: Memory,
    ) -> Self {
        Self {
            name,
            address,
            size,
            encoding,
            memory,
        }
    }

    pub fn name(self) -> &'static str {
        self.name
    }

    pub const fn address(self) -> u8 {
        self.address
    }

    /// Number of bytes: one or two.
    pub fn size(self) -> u8 {
        self.size
    }

    pub fn memory(self) -> Memory {
        self.memory
    }

    /// Address behind the register.
    pub(super) fn end(self) -> u8 {
        self.address + self.size
    }

    /// Returns the values that its bytes can hold.
    pub fn range(self) -> RangeInclusive<i32> {
        match self.encoding {
            Encoding::Unsigned if self.size == 1 => 0..=0xFF,
            Encoding::Unsigned => 0..=0xFFFF,
            Encoding::SignMagnitude(bit) => {
                let most = (1 << bit) - 1;
                -most..=most
            }
        }
    }

    /// Takes a value from its bytes. `None` if there are too few.
    pub(super) fn decode(self, bytes: &[u8]) -> Option<i32> {
        let raw = match self.size {
            1 => i32::from(*bytes.first()?),
            _ => i32::from(u16::from_le_bytes([*bytes.first()?, *bytes.get(1)?])),
        };
        let Encoding::SignMagnitude(bit) = self.encoding else {
            return Some(raw);
        };
        let magnitude = raw & ((1 << bit) - 1);
        let is_negative = raw & (1 << bit) != 0;
        Some(if is_negative { -magnitude } else { magnitude })
    }

    /// Appends a value to `bytes`. False if the register cannot hold it.
    pub(super) fn encode(self, value: i32, bytes: &mut Vec<u8>) -> bool {
        if !self.range().contains(&value) {
            return false;
        }
        let raw = match self.encoding {
            Encoding::SignMagnitude(bit) if value < 0 => -value | 1 << bit,
            _ => value,
        };
        let [low, high, ..] = raw.to_le_bytes();
        bytes.push(low);
        if self.size == 2 {
            bytes.push(high);
        }
        true
    }
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.name)
    }
}

/// Returns the register of a name, such as `present_position`.
pub fn find(name: &str) -> Option<Register> {
    ALL.into_iter().find(|register| register.name == name)
}

#[cfg(test)]
mod tests;
