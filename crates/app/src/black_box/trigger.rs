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
/// is, and so is the loss of a PC that steered. But each flag counts once between arming and disarming, so that a
/// flickering contact does not overwrite what came before.
#[derive(Clone, Debug, Default)]
pub struct StopWatch {
    armed: bool,
    /// Flags that have counted since arming, or were there when the robot was armed. The PC's are not among the latter:
    /// one that comes later can still be lost.
    counted: SafetyFlags,
    /// The PC steered in the report before.
    pc_steered: bool,
    /// Flags of the report before.
    before: SafetyFlags,
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
                self.counted = flags.difference(SafetyFlags::PC_STOP);
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
            (true, true) => self.partial_stop(report),
        };
        self.pc_steered = report.operator.mode == DriveMode::Pc
            && report.logic.pc_selected
            && !flags.intersects(SafetyFlags::PC_STOP);
        self.before = flags;
        event
    }

    fn partial_stop(&mut self, report: &DiagnosticsSnapshot) -> Option<Trigger> {
        let flags = report.safety.flags;
        let stops = flags.intersection(PARTIAL).union(self.pc_stop(report));
        let new = stops.difference(self.counted);
        if new.is_empty() {
            return None;
        }
        self.counted = self.counted.union(new).union(SafetyFlags::STICKS_AWAITED);
        if new.intersects(SafetyFlags::PC_LOST) {
            self.counted.insert(SafetyFlags::PC_AWAITED);
        }
        Some(Trigger {
            kind: EventKind::PartialStop,
            flags: new,
            blockers: ArmingBlockers::NONE,
        })
    }

    /// What stopped a PC that steered. A loss that was too short to be seen leaves a PC that must begin from rest, but so
    /// do a pilot who lets it go and any other stop.
    fn pc_stop(&self, report: &DiagnosticsSnapshot) -> SafetyFlags {
        let flags = report.safety.flags;
        let explained = !report.logic.pc_selected || flags.union(self.before).intersects(PARTIAL);
        match (self.pc_steered, explained) {
            (false, _) => SafetyFlags::NONE,
            (true, false) => flags.intersection(SafetyFlags::PC_STOP),
            (true, true) => flags.intersection(SafetyFlags::PC_LOST),
        }
    }
}
