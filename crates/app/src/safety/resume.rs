//! What was stopped in part goes on by itself only while the pilot's hands are off the sticks: legs and wheels that get
//! their supply back must not set off at full stick.

use super::SafetyFlags;

/// A silent wheel is driven open loop; when it is back, both wheels wait.
const SILENT_WHEELS: SafetyFlags =
    SafetyFlags::WHEEL_LEFT_SILENT.union(SafetyFlags::WHEEL_RIGHT_SILENT);
const WATCHED: SafetyFlags = SafetyFlags::WHEELS_STOP
    .union(SafetyFlags::JOINTS_STOP)
    .union(SafetyFlags::BUS_STOP[0])
    .union(SafetyFlags::BUS_STOP[1])
    .union(SILENT_WHEELS);

/// Remembers conditions that stopped a part.
#[derive(Clone, Debug, Default)]
pub(super) struct ResumeWatch {
    kept: SafetyFlags,
}

impl ResumeWatch {
    /// Takes the conditions there are; gives those whose stop lasts although they are over. `may_resume`: nothing has
    /// to wait now.
    pub fn step(&mut self, present: SafetyFlags, may_resume: bool) -> SafetyFlags {
        let watched = present.intersection(WATCHED);
        self.kept = if may_resume {
            watched
        } else {
            self.kept.union(watched)
        };
        let over = self.kept.without(watched);
        if over.intersects(SILENT_WHEELS) {
            over.union(SafetyFlags::WHEELS_STOP)
        } else {
            over
        }
    }
}
