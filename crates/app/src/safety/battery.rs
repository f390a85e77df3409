//! Judges the battery voltage: sags under load are short, an empty battery is not.

use super::{SafetyFlags, debounce::Excess};
use crate::domain::SafetyConfig;

const HOLD_US: u32 = 1_000_000;
/// A battery recovers by some tenths of a volt when the load goes.
const MARGIN_V: f32 = 0.5;
/// The C board itself does not run on less (8 V): the divider sees no battery.
const LEAST_PLAUSIBLE_V: f32 = 6.0;

#[derive(Clone, Debug, Default)]
pub(super) struct BatteryWatch {
    low: Excess,
    empty: Excess,
}

impl BatteryWatch {
    /// Not measured: low, but not empty. NaN: both.
    pub fn judge(
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
