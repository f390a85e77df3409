//! Stops that stay until a person has looked.

use super::{SafetyFlags, debounce::Debounce};

/// Latches flags and detects the pilot's clearing gesture: enable switch off and e-stop thrown together.
#[derive(Clone, Debug, Default)]
pub(super) struct Latches {
    latched: SafetyFlags,
    gesture: Debounce,
    /// The gesture has been held long enough and continues.
    clearing: bool,
}

impl Latches {
    /// The flags that are latched.
    pub const fn latched(&self) -> SafetyFlags {
        self.latched
    }

    /// Releases latched flags.
    pub fn release(&mut self, flags: SafetyFlags) {
        self.latched = self.latched.difference(flags);
    }

    /// Takes the flags present in this tick. Returns the latched ones, and whether joints shall clear their faults.
    ///
    /// After `hold_us` of the gesture, a latch is released as soon as its cause has ended; a joint's fault needs a
    /// few ticks for that. Joints get the order once every `hold_us`.
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
