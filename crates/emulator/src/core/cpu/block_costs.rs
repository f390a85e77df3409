//! Cost and aligned accesses of the blocks seen so far. They are looked up on every block.

use crate::core::{
    alignment::{WordAccesses, word_accesses},
    cost::{BlockCost, block_cost},
    memory::FLASH,
};

/// One slot for each halfword of 256 KiB, so no two blocks of an image of that size share a slot.
const SLOTS: usize = 1 << 17;

#[derive(Clone, Copy, Default)]
struct Slot {
    start: u32,
    size: u32,
    cost: BlockCost,
    /// Index of the block's accesses in the list of all accesses; 0 if it has none.
    accesses: u16,
}

/// A direct-mapped cache for code in flash. Code elsewhere may change, so its cost is computed each time.
pub(super) struct BlockCosts {
    slots: Vec<Slot>,
    accesses: Vec<WordAccesses>,
}

impl Default for BlockCosts {
    fn default() -> Self {
        Self {
            slots: vec![Slot::default(); SLOTS],
            accesses: vec![WordAccesses::default()],
        }
    }
}

impl BlockCosts {
    pub(super) fn known(&self, start: u32, size: u32) -> Option<(BlockCost, WordAccesses)> {
        let slot = &self.slots[slot_of(start)];
        let known = slot.start == start && slot.size == size;
        known.then(|| (slot.cost, self.accesses[usize::from(slot.accesses)]))
    }

    pub(super) fn learn(&mut self, start: u32, code: &[u8]) -> (BlockCost, WordAccesses) {
        let (cost, accesses) = (block_cost(code), word_accesses(code));
        let size = code.len() as u32;
        if FLASH.contains(start, size)
            && let Some(accesses) = self.keep(accesses)
        {
            self.slots[slot_of(start)] = Slot {
                start,
                size,
                cost,
                accesses,
            };
        }
        (cost, accesses)
    }

    /// Returns `None` if there is no room; the block is then analysed each time.
    fn keep(&mut self, accesses: WordAccesses) -> Option<u16> {
        if accesses == WordAccesses::default() {
            return Some(0);
        }
        let place = u16::try_from(self.accesses.len()).ok()?;
        self.accesses.push(accesses);
        Some(place)
    }
}

fn slot_of(start: u32) -> usize {
    start as usize / 2 % SLOTS
}
