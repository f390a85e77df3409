//! Decides which group of settings is saved next, and when. It does not access flash.

mod back_off;

pub use back_off::BackOff;

use crate::{
    domain::RobotConfig,
    tuning::{PARAMETERS, ParameterGroup, bit},
};

/// A save begins after this time without a change.
const QUIET_US: u64 = 500_000;

/// A group's index in `PARAMETERS`.
pub type GroupIndex = usize;

/// Compares what flash holds with what is in use.
#[derive(Clone, Debug)]
pub struct SaveScheduler {
    /// The settings that a boot would load. A group without a good record has its defaults.
    saved: RobotConfig,
    /// Groups for which flash may hold other values than `saved`, one bit each: an attempt failed, or a refused
    /// record is to be overwritten.
    uncertain: u32,
    /// Groups to be saved, one bit each.
    unsaved: u32,
    /// Revision of the configuration from which `unsaved` was computed.
    seen: u32,
    changed_at_us: u64,
    /// The group to try next. A group that cannot be saved does not block the others.
    next_group: GroupIndex,
}

impl SaveScheduler {
    pub fn new(saved: RobotConfig) -> Self {
        Self {
            saved,
            uncertain: 0,
            unsaved: 0,
            seen: 0,
            changed_at_us: 0,
            next_group: 0,
        }
    }

    /// Takes the present settings. `revision` changes whenever `config` or `forced` does. The bits of `forced`
    /// are groups to save even if a boot would load the same values.
    pub fn observe(&mut self, config: &RobotConfig, revision: u32, forced: u32, now_us: u64) {
        if revision == self.seen {
            return;
        }
        self.seen = revision;
        self.changed_at_us = now_us;
        self.uncertain |= forced;
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

    /// Groups that are not saved, one bit each.
    pub fn unsaved(&self) -> u32 {
        self.unsaved
    }

    /// Returns the group to save next, once nothing has changed for long enough.
    pub fn due(&self, now_us: u64) -> Option<(GroupIndex, &'static ParameterGroup)> {
        if self.unsaved == 0 || now_us.saturating_sub(self.changed_at_us) < QUIET_US {
            return None;
        }
        let waiting = || {
            let groups = PARAMETERS.iter().enumerate();
            groups.filter(|(position, _)| self.unsaved & bit(*position) != 0)
        };
        let from_turn = waiting().find(|(position, _)| *position >= self.next_group);
        from_turn.or_else(|| waiting().next())
    }

    /// Takes note that flash holds this group as it is in `config`.
    pub fn mark_saved(&mut self, position: GroupIndex, config: &RobotConfig) {
        if let Some(group) = PARAMETERS.get(position) {
            group.copy(config, &mut self.saved);
        }
        self.unsaved &= !bit(position);
        self.uncertain &= !bit(position);
    }

    /// Takes note that saving this group failed.
    pub fn mark_failed(&mut self, position: GroupIndex) {
        self.uncertain |= bit(position);
        self.next_group = position.saturating_add(1);
    }
}

#[cfg(test)]
mod tests;
