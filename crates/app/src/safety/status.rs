//! What the policy found in one tick.

use super::SafetyFlags;
use crate::domain::BusId;

/// How far outputs are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum SafetyVerdict {
    Run = 0,
    /// Only wheels, joints, or what is on one bus; see `SafetyStatus`.
    PartialStop = 1,
    #[default]
    GlobalStop = 2,
}

/// Flags and what they stop. Until the policy looked: everything stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct SafetyStatus {
    /// Present or latched.
    pub flags: SafetyFlags,
    /// Those of `flags` that stay until the pilot clears them.
    pub latched: SafetyFlags,
    pub verdict: SafetyVerdict,
    pub global_stop: bool,
    pub wheels_stop: bool,
    pub joints_stop: bool,
    /// Index = `BusId`.
    pub bus_stop: [bool; 2],
    /// In this tick the pilot clears latched stops: joints are told to clear their faults.
    pub clear_faults: bool,
    /// Every flag raised since boot.
    pub flags_seen: SafetyFlags,
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
            clear_faults: false,
            flags_seen: SafetyFlags::NONE,
        }
    }
}

impl SafetyStatus {
    /// What these flags stop. `latched`, `clear_faults` and `flags_seen` are left empty.
    pub(super) fn of(flags: SafetyFlags) -> Self {
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

    /// True if nothing else than these conditions stops any part.
    pub(super) fn would_run_without(&self, conditions: SafetyFlags) -> bool {
        Self::of(self.flags.without(conditions)).verdict == SafetyVerdict::Run
    }

    pub const fn stops_wheels(&self, bus: BusId) -> bool {
        self.global_stop || self.wheels_stop || self.stops_bus(bus)
    }

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
