//! Stops that stay until a human has looked.

use super::{SafetyFlags, debounce::Debounce};

/// Remembers latching flags and watches for the pilot's gesture: enable switch off and e-stop thrown together.
#[derive(Clone, Debug, Default)]
pub(super) struct Latches {
    latched: SafetyFlags,
    gesture: Debounce,
    /// The gesture was held long enough and still is.
    clearing: bool,
}

impl Latches {
    /// Takes the flags present in this tick; gives those that are latched, and whether joints shall clear their faults.
    ///
    /// As long as the gesture goes on after `hold_us`, latches go as soon as their cause is gone: a joint's fault needs
    /// a few ticks for that. Joints are told once every `hold_us`.
    pub fn step(
        &mut self,
        present: SafetyFlags,
        gesture: bool,
        dt_us: u32,
        hold_us: u32,
    ) -> (SafetyFlags, bool) {
        let clear_faults = self.gesture.held(gesture, dt_us, hold_us);
        if clear_faults {
            self.gesture.restart();
        }
        self.clearing = gesture && (self.clearing || clear_faults);
        if self.clearing {
            self.latched = SafetyFlags::NONE;
        }
        self.latched = self
            .latched
            .union(present.intersection(SafetyFlags::LATCHING));
        (self.latched, clear_faults)
    }
}
