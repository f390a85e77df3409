//! Twelve groups of settings in sectors 1–3, with their saves and what a boot finds.

use robot_plant::flash_chip::FlashChip;

pub const KEYS: u8 = 12;

/// A save as the user asks for it: the value follows from the key and its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Save {
    pub key: u8,
    pub number: u32,
}

impl Save {
    /// The `number`-th save of a user who goes through the groups again and again, and comes to the last one, set once
    /// when the robot was built, never more.
    pub fn nth(number: u32) -> Self {
        let key = match number {
            0 => KEYS - 1,
            _ => (number % u32::from(KEYS - 1)) as u8,
        };
        Self { key, number }
    }

    /// 20 … 60 bytes in words of 4, a fixed length for a key.
    pub fn value(self) -> Vec<u8> {
        let length = 20 + usize::from(self.key) * 10 / usize::from(KEYS - 1) * 4;
        let mut value = self.number.to_le_bytes().to_vec();
        value.extend((4..length as u8).map(|byte| byte.wrapping_mul(37) ^ self.key));
        value
    }
}

/// A store of the settings. Every call boots it.
pub trait Keeper: Sync {
    /// Whether the save was confirmed; the power may go before or after.
    fn save(&self, chip: &mut FlashChip, save: Save) -> bool;

    fn load(&self, chip: &mut FlashChip) -> [Found; KEYS as usize];
}

/// What a boot finds for a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    Save(Save),
    Nothing,
    /// An intact record that nobody stored.
    Strange,
    /// It was repaired as far as it can be, and is still said to be corrupted.
    Error,
}

impl Found {
    pub fn parse(key: u8, value: &[u8]) -> Self {
        let Some(number) = value.first_chunk().copied().map(u32::from_le_bytes) else {
            return Self::Strange;
        };
        let save = Save { key, number };
        if save.value() == value {
            Self::Save(save)
        } else {
            Self::Strange
        }
    }
}
