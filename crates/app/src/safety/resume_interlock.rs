//! A partially stopped robot resumes only when the pilot has released the sticks. Legs and wheels that regain their
//! supply must not start at full stick.

use super::SafetyFlags;

/// A silent wheel is driven open loop. When its feedback returns, both wheels wait.
const SILENT_WHEELS: SafetyFlags =
    SafetyFlags::WHEEL_LEFT_SILENT.union(SafetyFlags::WHEEL_RIGHT_SILENT);
/// The conditions that stop a part without disarming.
pub(super) const WATCHED: SafetyFlags = SafetyFlags::WHEELS_STOP
    .union(SafetyFlags::JOINTS_STOP)
    .union(SafetyFlags::BUS_STOP[0])
    .union(SafetyFlags::BUS_STOP[1])
    .union(SILENT_WHEELS);

/// Remembers the conditions that stopped a part.
#[derive(Clone, Debug, Default)]
pub(super) struct ResumeInterlock {
    held: SafetyFlags,
}

impl ResumeInterlock {
    /// Takes the present conditions. Returns the ended ones whose stop continues. If `may_resume` is true, none
    /// continues.
    pub fn step(&mut self, present: SafetyFlags, may_resume: bool) -> SafetyFlags {
        let watched = present.intersection(WATCHED);
        self.held = if may_resume {
            watched
        } else {
            self.held.union(watched)
        };
        let over = self.held.difference(watched);
        if over.intersects(SILENT_WHEELS) {
            over.union(SafetyFlags::WHEELS_STOP)
        } else {
            over
        }
    }
}
