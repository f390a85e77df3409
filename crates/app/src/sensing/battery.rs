//! Converter counts → battery voltage: median over a tenth of a second, against the chip's own reference.
//!
//! A load that switches makes the voltage sag for some milliseconds, in a rhythm of its own. A single reading taken now
//! and then can meet every sag and nothing else; the median of readings every 5 ms shows what the battery has most of
//! the time, 50 ms late.

/// The battery stands behind 200 kΩ over 22 kΩ.
const DIVIDER: f32 = (200.0 + 22.0) / 22.0;
const FULL_SCALE: f32 = 4_095.0;
/// The supply at which the reference was calibrated, and what the board's regulator should give.
const NOMINAL_SUPPLY_V: f32 = 3.3;
/// Typical reference (STM32F405/407 datasheet, embedded reference voltage: 1.18 to 1.24 V) at 3.3 V, in counts.
const NOMINAL_REFERENCE: f32 = 1.21 / NOMINAL_SUPPLY_V * FULL_SCALE;
/// A calibration word that no chip within the datasheet has, with a little to spare.
const PLAUSIBLE_CALIBRATION: core::ops::RangeInclusive<u16> = 1_440..=1_560;
/// What the chip works at. A supply outside is a reference that was not measured.
const PLAUSIBLE_SUPPLY_V: core::ops::RangeInclusive<f32> = 2.7..=3.7;
/// Readings in the median, odd so that one is in the middle: 100 ms from the first to the last.
const WINDOW: usize = 21;
/// Share of a new reading in what counts as the reference.
const REFERENCE_SHARE: f32 = 1.0 / 16.0;

/// Feed every 5 ms.
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
    /// `calibration`: the maker's word VREFIN_CAL; the typical value stands in for one that cannot be true.
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

    /// Counts of battery and reference at 12 bits; `None` where a conversion brought nothing.
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

    /// V at the battery; 0 while it is not measured.
    pub fn volts(&self) -> f32 {
        if self.filled < WINDOW {
            return 0.0;
        }
        f32::from(median(&self.window)) / FULL_SCALE * self.supply_v() * DIVIDER
    }

    /// What full scale of the converters means now.
    fn supply_v(&self) -> f32 {
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

    /// 24 V are 2.378 V at the pin, at 3.3 V 2951 counts.
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
        // A chip of 1.217 V was calibrated to 1510.
        assert!((steady(1_510, FULL, 1_510) - 24.0).abs() < 0.02);
        // At 3.4 V everything reads 3 % less, at 3.2 V 3 % more.
        assert!((steady(1_510, 2_864, 1_466) - 24.0).abs() < 0.02);
        assert!((steady(1_510, 3_043, 1_557) - 24.0).abs() < 0.02);
    }

    #[test]
    fn what_cannot_be_true_is_replaced_by_the_typical_value() {
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

    /// 15 ms of every 250 ms at 18.5 V, whatever the moment one looks at.
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

    /// Down and up again half a window late, so that a sag counts as long as it lasts.
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

    /// Against sorting, with equal values among them.
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
    fn a_battery_is_unmeasured_until_the_window_is_full_and_when_conversions_fail() {
        assert_eq!(fed(1_510, [(Some(FULL), Some(1_510)); 20]), 0.0);
        let good = [(Some(FULL), Some(1_510)); 21];
        let gone = |times| good.into_iter().chain(vec![(None, Some(1_510)); times]);
        assert!(fed(1_510, gone(20)) > 23.0);
        assert_eq!(fed(1_510, gone(21)), 0.0);
    }
}
