//! Decides when an event happens.

use crate::{
    diagnostics::DiagnosticsSnapshot,
    domain::{DriveMode, EventKind},
    safety::{ArmingBlockers, ArmingState, SafetyFlags},
};

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trigger {
    pub kind: EventKind,
    /// The flags that caused it.
    pub flags: SafetyFlags,
    /// What disarmed the robot.
    pub blockers: ArmingBlockers,
}

/// Watches an armed robot for stops that nobody asked for.
///
/// A disarming is one unless [`DriveEnd::was_asked_for`](crate::safety::DriveEnd::was_asked_for). A partial stop always
/// is, but each flag counts once between arming and disarming, so that a flickering contact does not overwrite what
/// came before.
#[derive(Clone, Debug, Default)]
pub struct StopWatch {
    armed: bool,
    /// Flags that have counted since arming, or were there when the robot was armed.
    counted: SafetyFlags,
    /// The PC steered in the report before.
    pc_steered: bool,
}

/// Flags that stop something on a robot that stays armed. The last one remains after a stop that was too short to be
/// seen.
const PARTIAL: SafetyFlags = SafetyFlags::WHEELS_STOP
    .union(SafetyFlags::JOINTS_STOP)
    .union(SafetyFlags::BUS_STOP[0])
    .union(SafetyFlags::BUS_STOP[1])
    .union(SafetyFlags::COMMAND_STALE)
    .union(SafetyFlags::STICKS_AWAITED);

impl StopWatch {
    /// Takes a report. Returns what happened since the one before.
    pub fn step(&mut self, report: &DiagnosticsSnapshot) -> Option<Trigger> {
        let flags = report.safety.flags;
        let was_armed = self.armed;
        self.armed = report.arming.state == ArmingState::Armed;
        let event = match (was_armed, self.armed) {
            (false, false) => None,
            (false, true) => {
                self.counted = flags;
                None
            }
            (true, false) => {
                let end = &report.drive_end;
                (!end.was_asked_for()).then_some(Trigger {
                    kind: EventKind::Stop,
                    flags: end.flags,
                    blockers: end.blockers,
                })
            }
            (true, true) => self.partial_stop(flags),
        };
        self.pc_steered = report.operator.mode == DriveMode::Pc
            && report.logic.pc_selected
            && !flags.intersects(SafetyFlags::PC_STOP);
        event
    }

    fn partial_stop(&mut self, flags: SafetyFlags) -> Option<Trigger> {
        let mut new = flags.intersection(PARTIAL).difference(self.counted);
        // A PC that does not yet steer cannot be lost.
        if self.pc_steered && flags.intersects(SafetyFlags::PC_LOST) {
            new = new.union(SafetyFlags::PC_LOST).difference(self.counted);
        }
        if new.is_empty() {
            return None;
        }
        self.counted = self.counted.union(new).union(SafetyFlags::STICKS_AWAITED);
        Some(Trigger {
            kind: EventKind::PartialStop,
            flags: new,
            blockers: ArmingBlockers::NONE,
        })
    }
}
