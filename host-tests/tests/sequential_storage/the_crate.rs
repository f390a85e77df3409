//! The settings kept by sequential-storage.

use robot_plant::flash_chip::{FlashChip, FlashError};
use sequential_storage::{
    Error,
    cache::{Cache, Uncached, key_pointers::ArrayKeyPointers},
    map::{MapConfig, MapStorage},
};

use crate::{
    flash::{Chip, block_on},
    settings::{Found, KEYS, Keeper, Save},
};

type KeyCache = ArrayKeyPointers<u8, { KEYS as usize }>;
type Storage<'a> = MapStorage<u8, Chip<'a>, Cache<Uncached, Uncached, KeyCache, u8>>;

pub struct SequentialStorage;

impl Keeper for SequentialStorage {
    fn save(&self, chip: &mut FlashChip, save: Save) -> bool {
        let (value, mut buffer) = (save.value(), [0; 128]);
        block_on(storage(chip).store_item(&mut buffer, &save.key, &value.as_slice())).is_ok()
    }

    /// Reads all records in one pass, in which the last record of a key counts. If that fails, it reads key by key, because
    /// only that repairs the flash.
    fn load(&self, chip: &mut FlashChip) -> [Found; KEYS as usize] {
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
}

/// The storage after a boot, with an empty key cache. Without a cache a change of the sector takes some 60 ms on a PC.
fn storage(chip: &mut FlashChip) -> Storage<'_> {
    let config = const { MapConfig::new(0..0xC000) };
    let cache = Cache::new(Uncached, Uncached, KeyCache::new());
    MapStorage::new(Chip(chip), config, cache)
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
