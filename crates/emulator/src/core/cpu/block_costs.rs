//! Costs of the blocks seen so far, looked up on every block.

use crate::core::{
    cost::{BlockCost, block_cost},
    memory::FLASH,
};

/// One for each halfword of the largest image the design allows, and twice that: no two blocks of it share one.
const SLOTS: usize = 1 << 17;

#[derive(Clone, Copy, Default)]
struct Slot {
    start: u32,
    size: u32,
    cost: BlockCost,
}

/// A direct-mapped cache for code in flash; code elsewhere may change under it and is costed anew each time.
pub(super) struct BlockCosts {
    slots: Vec<Slot>,
}

impl Default for BlockCosts {
    fn default() -> Self {
        Self {
            slots: vec![Slot::default(); SLOTS],
        }
    }
}

impl BlockCosts {
    pub(super) fn known(&self, start: u32, size: u32) -> Option<BlockCost> {
        let slot = &self.slots[slot_of(start)];
        (slot.start == start && slot.size == size).then_some(slot.cost)
    }

    pub(super) fn learn(&mut self, start: u32, code: &[u8]) -> BlockCost {
        let cost = block_cost(code);
        let size = code.len() as u32;
        if FLASH.contains(start, size) {
            self.slots[slot_of(start)] = Slot { start, size, cost };
        }
        cost
    }
}

fn slot_of(start: u32) -> usize {
    start as usize / 2 % SLOTS
}
