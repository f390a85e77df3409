//! The worst case of the flash interface's data cache. It holds every word that the core could have read while it was on,
//! and drops none until it is reset (RM0090 3.5.2).

use std::collections::HashMap;

#[derive(Debug, Default)]
pub struct DataCache {
    /// Words that differ, or may differ, from the cells.
    stale: HashMap<u32, u32>,
    on: bool,
    /// Whether it was on at some time since its last reset.
    may_hold: bool,
}

impl DataCache {
    pub fn switch(&mut self, on: bool) {
        self.on = on;
        self.may_hold |= on;
    }

    /// Empties the cache, which is possible only while it is off.
    pub fn reset(&mut self) {
        self.stale.clear();
        self.may_hold = false;
    }

    /// The cached word at `address`, which the core reads instead of the cells' word.
    pub fn word(&self, address: u32) -> Option<u32> {
        self.stale.get(&address).copied().filter(|_| self.on)
    }

    /// Notes a store, which goes to the cells and to the cache. In the cache it always succeeds.
    pub fn programmed(&mut self, address: u32, word: u32) {
        if self.may_hold {
            self.stale.insert(address, word);
        }
    }

    /// Notes an erase, which goes to the cells only.
    pub fn erased(&mut self, before: impl Iterator<Item = (u32, u32)>) {
        if self.may_hold {
            for (address, word) in before {
                self.stale.entry(address).or_insert(word);
            }
        }
    }
}
