//! Twelve groups of settings kept by the crate in sectors 1–3: what is stored, and what a boot finds.

use robot_plant::flash_chip::{FlashChip, FlashError};
use sequential_storage::{
    Error,
    cache::{Cache, Uncached, key_pointers::ArrayKeyPointers},
    map::{MapConfig, MapStorage},
};

use crate::flash::{Chip, block_on};

pub const KEYS: u8 = 12;

type KeyCache = ArrayKeyPointers<u8, { KEYS as usize }>;
type Storage<'a> = MapStorage<u8, Chip<'a>, Cache<Uncached, Uncached, KeyCache, u8>>;

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

    /// 20 … 60 bytes, a fixed length for a key.
    pub fn value(self) -> Vec<u8> {
        let length = 20 + usize::from(self.key) * 40 / usize::from(KEYS - 1);
        let mut value = self.number.to_le_bytes().to_vec();
        value.extend((4..length as u8).map(|byte| byte.wrapping_mul(37) ^ self.key));
        value
    }
}

/// What a boot makes of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    Save(Save),
    Nothing,
    /// An intact record that nobody stored.
    Strange,
    /// The crate repaired as far as it can and still says "corrupted".
    Error,
}

impl Found {
    fn parse(key: u8, value: &[u8]) -> Self {
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

/// As after a boot: the cache is empty. Without one, a change of the sector takes some 60 ms on a PC.
fn storage(chip: &mut FlashChip) -> Storage<'_> {
    let config = const { MapConfig::new(0..0xC000) };
    let cache = Cache::new(Uncached, Uncached, KeyCache::new());
    MapStorage::new(Chip(chip), config, cache)
}

pub fn store(chip: &mut FlashChip, save: Save) -> Result<(), Error<FlashError>> {
    let value = save.value();
    block_on(storage(chip).store_item(&mut [0; 128], &save.key, &value.as_slice()))
}

/// A boot. All records are read in one go, the last of a key counts; where that fails, key by key, as only that repairs.
pub fn load(chip: &mut FlashChip) -> [Found; KEYS as usize] {
    load_all(chip).unwrap_or_else(|_| {
        let mut storage = storage(chip);
        std::array::from_fn(|key| {
            let (key, mut buffer) = (key as u8, [0; 128]);
            match block_on(storage.fetch_item::<&[u8]>(&mut buffer, &key)) {
                Ok(Some(value)) => Found::parse(key, value),
                Ok(None) => Found::Nothing,
                Err(_) => Found::Error,
            }
        })
    })
}

fn load_all(chip: &mut FlashChip) -> Result<[Found; KEYS as usize], Error<FlashError>> {
    let mut found = [Found::Nothing; KEYS as usize];
    let mut buffer = [0; 128];
    let mut storage = storage(chip);
    block_on(async {
        let mut records = storage.fetch_all_items(&mut buffer).await?;
        while let Some((key, value)) = records.next::<&[u8]>(&mut buffer).await? {
            if let Some(place) = found.get_mut(usize::from(key)) {
                *place = Found::parse(key, value);
            }
        }
        Ok(found)
    })
}
