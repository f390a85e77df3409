//! Checks the battery voltage. Sags under load are short; an empty battery stays low.

use super::{SafetyFlags, debounce::DebouncedLimit};
use crate::domain::SafetyConfig;

const HOLD_US: u32 = 1_000_000;
/// A battery recovers by some tenths of a volt when the load ends.
const MARGIN_V: f32 = 0.5;
/// Below this the divider measures no battery: the C board itself needs 8 V.
const LEAST_PLAUSIBLE_V: f32 = 6.0;

#[derive(Clone, Debug, Default)]
pub(super) struct BatteryLimits {
    low: DebouncedLimit,
    empty: DebouncedLimit,
}

impl BatteryLimits {
    /// Sets the battery flags. An unmeasured battery is low but not empty; NaN is both.
    pub fn check(
        &mut self,
        battery_v: f32,
        config: &SafetyConfig,
        dt_us: u32,
        flags: &mut SafetyFlags,
    ) {
        let measured = battery_v.is_nan() || battery_v >= LEAST_PLAUSIBLE_V;
        let off = config.battery_low_v == 0.0;
        let above = |limit_v: f32, margin_v: f32| off || battery_v >= limit_v + margin_v;
        let low = self.low.step(
            |margin_v| above(config.battery_low_v, margin_v),
            MARGIN_V,
            dt_us,
            HOLD_US,
        );
        let empty = self.empty.step(
            |margin_v| !measured || above(config.battery_empty_v, margin_v),
            MARGIN_V,
            dt_us,
            HOLD_US,
        );
        flags.add_if(SafetyFlags::BATTERY_LOW, low);
        flags.add_if(SafetyFlags::BATTERY_EMPTY, empty);
    }
}
