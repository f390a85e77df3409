//! ADC counts → battery voltage: a median over 100 ms, compared to the chip's own reference.
//!
//! A switching load makes the voltage sag for some milliseconds, again and again. A single reading now and then can
//! meet every sag and nothing else. The median of readings every 5 ms shows what the battery has most of the time, 50
//! ms late.

/// The voltage divider: 200 kΩ over 22 kΩ.
const DIVIDER: f32 = (200.0 + 22.0) / 22.0;
const FULL_SCALE: f32 = 4_095.0;
/// The supply voltage at which the reference was calibrated, and the nominal one of the board.
const NOMINAL_SUPPLY_V: f32 = 3.3;
/// Typical reference at that supply, in counts (STM32F405/407 datasheet, embedded reference voltage: 1.18 to 1.24 V).
const NOMINAL_REFERENCE: f32 = 1.21 / NOMINAL_SUPPLY_V * FULL_SCALE;
/// Calibration words within the datasheet's limits, with a small margin.
const PLAUSIBLE_CALIBRATION: core::ops::RangeInclusive<u16> = 1_440..=1_560;
/// Supply voltages at which the chip works. A value outside means that the reference was not measured.
const PLAUSIBLE_SUPPLY_V: core::ops::RangeInclusive<f32> = 2.7..=3.7;
/// Readings in the median, 100 ms from the first to the last. The number is odd, so that one is in the middle.
const WINDOW: usize = 21;
/// Weight of a new reading in the smoothed reference.
const REFERENCE_SHARE: f32 = 1.0 / 16.0;

/// Measures the battery voltage from ADC readings every 5 ms.
///
/// ```
/// use robot_app::sensing::BatteryMonitor;
///
/// // This chip's VREFIN_CAL, its reference in counts at 3.3 V.
/// let mut monitor = BatteryMonitor::new(1_510);
/// for _ in 0..21 {
///     assert_eq!(monitor.volts(), 0.0, "not measured yet");
///     // 2951 counts are 2.378 V at the pin.
///     monitor.feed(Some(2_951), Some(1_510));
/// }
/// assert!((monitor.volts() - 24.0).abs() < 0.02);
/// ```
#[derive(Clone, Debug)]
pub struct BatteryMonitor {
    /// Counts of the reference at 3.3 V.
    calibration: f32,
    reference: Option<f32>,
    window: [u16; WINDOW],
    filled: usize,
    next: usize,
    missing: usize,
}

impl BatteryMonitor {
    /// `calibration` is the factory's word VREFIN_CAL. If it is not plausible, the typical value replaces it.
    pub fn new(calibration: u16) -> Self {
        Self {
            calibration: if PLAUSIBLE_CALIBRATION.contains(&calibration) {
                f32::from(calibration)
            } else {
                NOMINAL_REFERENCE
            },
            reference: None,
            window: [0; WINDOW],
            filled: 0,
            next: 0,
            missing: 0,
        }
    }

    /// Takes 12-bit counts of battery and reference. `None` means that a conversion brought nothing.
    pub fn feed(&mut self, battery: Option<u16>, reference: Option<u16>) {
        if let Some(counts) = reference.map(f32::from) {
            let before = self.reference.unwrap_or(counts);
            self.reference = Some(before + (counts - before) * REFERENCE_SHARE);
        }
        let Some(counts) = battery else {
            self.missing = self.missing.saturating_add(1);
            if self.missing >= WINDOW {
                self.filled = 0;
            }
            return;
        };
        self.missing = 0;
        if let Some(slot) = self.window.get_mut(self.next) {
            *slot = counts;
        }
        self.next = self.next.wrapping_add(1) % WINDOW;
        self.filled = self.filled.saturating_add(1).min(WINDOW);
    }

    /// Battery voltage in V. It is 0 until 21 readings are there, and again after 21 readings in a row are missing.
    pub fn volts(&self) -> f32 {
        if self.filled < WINDOW {
            return 0.0;
        }
        f32::from(median(&self.window)) / FULL_SCALE * self.supply_v() * DIVIDER
    }

    /// Supply voltage of the ADC, which is its full scale, V.
    pub fn supply_v(&self) -> f32 {
        let measured = self
            .reference
            .map(|counts| NOMINAL_SUPPLY_V * self.calibration / counts);
        measured
            .filter(|volts| PLAUSIBLE_SUPPLY_V.contains(volts))
            .unwrap_or(NOMINAL_SUPPLY_V)
    }
}

fn median(window: &[u16; WINDOW]) -> u16 {
    let count = |is_counted: &dyn Fn(u16) -> bool| {
        let counted = window.iter().filter(|value| is_counted(**value));
        counted.count()
    };
    let mut values = window.iter().copied();
    let middle = values.find(|&value| {
        count(&|other| other < value) <= WINDOW / 2 && count(&|other| other <= value) > WINDOW / 2
    });
    middle.unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 24 V are 2.378 V at the pin, 2951 counts at 3.3 V.
    const FULL: u16 = 2_951;
    /// 18.5 V.
    const EMPTY: u16 = 2_275;

    fn fed(calibration: u16, counts: impl IntoIterator<Item = (Option<u16>, Option<u16>)>) -> f32 {
        let mut monitor = BatteryMonitor::new(calibration);
        for (battery, reference) in counts {
            monitor.feed(battery, reference);
        }
        monitor.volts()
    }

    fn steady(calibration: u16, battery: u16, reference: u16) -> f32 {
        fed(calibration, [(Some(battery), Some(reference)); 100])
    }

    #[test]
    fn the_reference_corrects_the_supply() {
        // A reference of 1.217 V was calibrated to 1510.
        assert!((steady(1_510, FULL, 1_510) - 24.0).abs() < 0.02);
        // At 3.4 V all counts are 3 % lower, at 3.2 V 3 % higher.
        assert!((steady(1_510, 2_864, 1_466) - 24.0).abs() < 0.02);
        assert!((steady(1_510, 3_043, 1_557) - 24.0).abs() < 0.02);
    }

    #[test]
    fn implausible_values_are_replaced_by_the_typical_one() {
        // 1.21 V are 1501.5 counts.
        for calibration in [0, 1_439, 1_561, u16::MAX] {
            assert!((steady(calibration, FULL, 1_501) - 24.0).abs() < 0.05);
        }
        assert!((steady(1_440, FULL, 1_440) - 24.0).abs() < 0.05);
        for reference in [0, 1_000, 4_095] {
            assert!((steady(1_510, FULL, reference) - 24.0).abs() < 0.02);
        }
        assert!((fed(1_510, [(Some(FULL), None); 21]) - 24.0).abs() < 0.02);
    }

    /// 15 ms of every 250 ms are at 18.5 V.
    #[test]
    fn short_sags_do_not_show() {
        let mut monitor = BatteryMonitor::new(1_510);
        for step in 0..500 {
            let counts = if step % 50 < 3 { EMPTY } else { FULL };
            monitor.feed(Some(counts), Some(1_510));
            let volts = monitor.volts();
            assert!(step < 20 || (volts - 24.0).abs() < 0.02, "{volts} V");
        }
    }

    /// The voltage falls and rises half a window late, so that a sag shows for as long as it lasts.
    #[test]
    fn a_sag_shows_for_as_long_as_it_lasts() {
        let mut monitor = BatteryMonitor::new(1_510);
        let mut low = Vec::new();
        for step in 0..300 {
            let counts = if (100..200).contains(&step) {
                EMPTY
            } else {
                FULL
            };
            monitor.feed(Some(counts), Some(1_510));
            if step >= 20 && monitor.volts() < 19.0 {
                low.push(step);
            }
        }
        assert_eq!((low.first(), low.len()), (Some(&110), 100));
    }

    /// Compared to sorting, with equal values among the readings.
    #[test]
    fn the_median_is_the_middle_one() {
        let mut state = 1u32;
        for _ in 0..1_000 {
            let window = std::array::from_fn(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 28) as u16
            });
            let mut sorted: [u16; WINDOW] = window;
            sorted.sort_unstable();
            assert_eq!(median(&window), sorted[10], "{window:?}");
        }
    }

    #[test]
    fn the_voltage_is_zero_until_the_window_is_full_and_when_conversions_fail() {
        assert_eq!(fed(1_510, [(Some(FULL), Some(1_510)); 20]), 0.0);
        let good = [(Some(FULL), Some(1_510)); 21];
        let gone = |times| good.into_iter().chain(vec![(None, Some(1_510)); times]);
        assert!(fed(1_510, gone(20)) > 23.0);
        assert_eq!(fed(1_510, gone(21)), 0.0);
    }
}
