//! The policy's result in one tick.

use super::SafetyFlags;
use crate::domain::{BusId, StandPermit};

/// How far outputs are stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum SafetyVerdict {
    /// Nothing is stopped.
    Run = 0,
    /// Only the wheels, the joints, or the actuators of one bus are stopped; see `SafetyStatus`.
    PartialStop = 1,
    /// Every actuator is stopped.
    #[default]
    GlobalStop = 2,
}

/// Flags and the stops they cause. Everything is stopped until the policy has run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct SafetyStatus {
    /// The conditions that are present or latched.
    pub flags: SafetyFlags,
    /// The conditions that stay until the pilot clears them.
    pub latched: SafetyFlags,
    /// How far outputs are stopped.
    pub verdict: SafetyVerdict,
    /// Every actuator is stopped.
    pub global_stop: bool,
    /// Both wheels are stopped.
    pub wheels_stop: bool,
    /// All joints are stopped.
    pub joints_stop: bool,
    /// All actuators of the bus are stopped. Index = `BusId`.
    pub bus_stop: [bool; 2],
    /// The PC's command has no effect: the mode switch is elsewhere, bring-up is on, or `PC_STOP` holds.
    pub pc_stop: bool,
    /// The pilot clears latched stops in this tick, and joints get the order to clear their faults.
    pub clear_faults: bool,
    /// Every flag raised since boot.
    pub flags_seen: SafetyFlags,
    /// How far the pilot's request to stand has come.
    pub stand: StandPermit,
    /// Time in ms that standing up has taken so far. It keeps its last value afterwards.
    pub stand_up_ms: u16,
}

impl Default for SafetyStatus {
    fn default() -> Self {
        Self {
            flags: SafetyFlags::NONE,
            latched: SafetyFlags::NONE,
            verdict: SafetyVerdict::GlobalStop,
            global_stop: true,
            wheels_stop: true,
            joints_stop: true,
            bus_stop: [true; 2],
            pc_stop: true,
            clear_faults: false,
            flags_seen: SafetyFlags::NONE,
            stand: StandPermit::SwitchMustGoDown,
            stand_up_ms: 0,
        }
    }
}

impl SafetyStatus {
    /// The stops caused by `flags`. The other fields keep their defaults.
    pub(super) fn from_flags(flags: SafetyFlags) -> Self {
        let global_stop = flags.intersects(SafetyFlags::GLOBAL_STOP);
        let wheels_stop = flags.intersects(SafetyFlags::WHEELS_STOP);
        let joints_stop = flags.intersects(SafetyFlags::JOINTS_STOP);
        let bus_stop = SafetyFlags::BUS_STOP.map(|bus| flags.intersects(bus));
        let verdict = if global_stop {
            SafetyVerdict::GlobalStop
        } else if wheels_stop || joints_stop || bus_stop.contains(&true) {
            SafetyVerdict::PartialStop
        } else {
            SafetyVerdict::Run
        };
        Self {
            flags,
            verdict,
            global_stop,
            wheels_stop,
            joints_stop,
            bus_stop,
            ..Self::default()
        }
    }

    /// Whether only these conditions stop anything.
    pub(super) fn would_run_without(&self, conditions: SafetyFlags) -> bool {
        Self::from_flags(self.flags.difference(conditions)).verdict == SafetyVerdict::Run
    }

    /// Whether wheels on this bus are stopped.
    pub const fn stops_wheels(&self, bus: BusId) -> bool {
        self.global_stop || self.wheels_stop || self.stops_bus(bus)
    }

    /// Whether joints on this bus are stopped.
    pub const fn stops_joints(&self, bus: BusId) -> bool {
        self.global_stop || self.joints_stop || self.stops_bus(bus)
    }

    const fn stops_bus(&self, bus: BusId) -> bool {
        let [can1, can2] = self.bus_stop;
        match bus {
            BusId::Can1 => can1,
            BusId::Can2 => can2,
        }
    }
}
