//! Which group of settings is saved, and when: pure bookkeeping, no flash.

mod back_off;

pub use back_off::BackOff;

use crate::{
    domain::RobotConfig,
    tuning::{PARAMETERS, ParameterGroup, bit},
};

/// Nothing is saved before nothing has changed for this long.
const QUIET_US: u64 = 500_000;

/// A group's position in `PARAMETERS`.
pub type Position = usize;

/// What flash holds, against what is in use.
#[derive(Clone, Debug)]
pub struct Saver {
    /// What a boot now would begin with: of a group without a good record, the defaults.
    saved: RobotConfig,
    /// Bits are positions: an attempt failed, or a refused record is to be overwritten. Flash may hold another value
    /// than `saved`.
    uncertain: u32,
    /// Bits are positions: to be saved.
    unsaved: u32,
    /// Of the configuration `unsaved` was found with.
    seen: u32,
    changed_at_us: u64,
    /// Whose turn it is: a group that cannot be saved does not keep the others waiting.
    turn: Position,
}

impl Saver {
    pub fn new(saved: RobotConfig) -> Self {
        Self {
            saved,
            uncertain: 0,
            unsaved: 0,
            seen: 0,
            changed_at_us: 0,
            turn: 0,
        }
    }

    /// `revision` differs from the last one if `config` or `overruled` does. Bits of `overruled` are positions: groups
    /// to be saved even if they are what a boot would begin with.
    pub fn observe(&mut self, config: &RobotConfig, revision: u32, overruled: u32, now_us: u64) {
        if revision == self.seen {
            return;
        }
        self.seen = revision;
        self.changed_at_us = now_us;
        self.uncertain |= overruled;
        self.unsaved = self.uncertain;
        for (position, group) in PARAMETERS.iter().enumerate() {
            if !group.is_same(config, &self.saved) {
                self.unsaved |= bit(position);
            }
        }
    }

    pub fn seen(&self) -> u32 {
        self.seen
    }

    /// Bits are positions in `PARAMETERS`.
    pub fn unsaved(&self) -> u32 {
        self.unsaved
    }

    /// The group to save next, once nothing has changed for long enough.
    pub fn due(&self, now_us: u64) -> Option<(Position, &'static ParameterGroup)> {
        if self.unsaved == 0 || now_us.saturating_sub(self.changed_at_us) < QUIET_US {
            return None;
        }
        let waiting = || {
            let groups = PARAMETERS.iter().enumerate();
            groups.filter(|(position, _)| self.unsaved & bit(*position) != 0)
        };
        let from_turn = waiting().find(|(position, _)| *position >= self.turn);
        from_turn.or_else(|| waiting().next())
    }

    /// Flash holds this group as it is in `config`.
    pub fn saved(&mut self, position: Position, config: &RobotConfig) {
        if let Some(group) = PARAMETERS.get(position) {
            group.copy(config, &mut self.saved);
        }
        self.unsaved &= !bit(position);
        self.uncertain &= !bit(position);
    }

    /// An attempt to save this group failed.
    pub fn failed(&mut self, position: Position) {
        self.uncertain |= bit(position);
        self.turn = position.saturating_add(1);
    }
}

#[cfg(test)]
mod tests;
