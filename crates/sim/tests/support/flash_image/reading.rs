//! What a dump of the parameter sectors means.

use std::collections::BTreeMap;

use super::{
    CLEAN, COPIES_AT, COPY_BYTES, CRC_AT, HEADER_AT, Id, LAST_SLOT, MAGIC, MAX_VALUES, PROOF_AT,
    SECTOR_BYTES, SLOT_BYTES, STORE_BYTES, Stored, VALUES_AT, crc32, word,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorState {
    /// Erased to the end, and nothing written since.
    Clean,
    /// Holds records; the highest generation is the active one.
    Headed {
        generation: u32,
    },
    Garbage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectorSeen {
    pub state: SectorState,
    /// Slots that are not blank, up to the last of them.
    pub used: usize,
    /// Slots among them without a good record.
    pub damaged: usize,
}

/// The newest copy of every record: those of lower generations first, then the active sector's over them.
pub fn newest(flash: &[u8]) -> BTreeMap<Id, Stored> {
    assert_eq!(flash.len(), STORE_BYTES);
    let mut headed: Vec<(u32, &[u8])> = flash
        .chunks_exact(SECTOR_BYTES)
        .filter_map(|sector| Some((generation(sector)?, sector)))
        .collect();
    headed.sort_by_key(|(generation, _)| *generation);
    let slots = headed.into_iter().flat_map(|(_, sector)| slots(sector));
    slots.filter_map(record).collect()
}

pub fn states(flash: &[u8]) -> Vec<SectorState> {
    assert_eq!(flash.len(), STORE_BYTES);
    flash.chunks_exact(SECTOR_BYTES).map(state).collect()
}

pub fn sectors(flash: &[u8]) -> Vec<SectorSeen> {
    assert_eq!(flash.len(), STORE_BYTES);
    flash.chunks_exact(SECTOR_BYTES).map(seen).collect()
}

fn seen(sector: &[u8]) -> SectorSeen {
    let last = slots(sector).rposition(|slot| !is_blank(slot));
    let used = last.map_or(0, |last| last + 1);
    let damaged = slots(sector)
        .take(used)
        .filter(|slot| record(slot).is_none());
    SectorSeen {
        state: state(sector),
        used,
        damaged: damaged.count(),
    }
}

fn state(sector: &[u8]) -> SectorState {
    match generation(sector) {
        Some(generation) => SectorState::Headed { generation },
        None if sector[..4] == CLEAN && is_blank(&sector[4..]) => SectorState::Clean,
        None => SectorState::Garbage,
    }
}

/// Generation in the first valid copy of the head.
fn generation(sector: &[u8]) -> Option<u32> {
    COPIES_AT.into_iter().find_map(|at| {
        let copy = &sector[at..at + COPY_BYTES];
        let generation = word(copy, 4);
        let good = copy[..4] == MAGIC
            && word(copy, 8) == !generation
            && word(copy, 12) == crc32(&copy[..12]);
        good.then_some(generation)
    })
}

fn slots(sector: &[u8]) -> impl DoubleEndedIterator<Item = &[u8]> + ExactSizeIterator {
    sector[SLOT_BYTES..]
        .chunks_exact(SLOT_BYTES)
        .take(LAST_SLOT)
}

fn record(slot: &[u8]) -> Option<(Id, Stored)> {
    let [key, version, count, variant] = *slot[HEADER_AT..].first_chunk()?;
    let count = usize::from(count);
    if count > MAX_VALUES || word(slot, CRC_AT) != crc32(&slot[HEADER_AT..PROOF_AT]) {
        return None;
    }
    let values = (0..count).map(|n| word(slot, VALUES_AT + 4 * n)).collect();
    Some(((key, variant), Stored { version, values }))
}

fn is_blank(bytes: &[u8]) -> bool {
    bytes.iter().all(|byte| *byte == 0xFF)
}
