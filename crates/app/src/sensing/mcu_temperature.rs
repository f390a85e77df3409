//! ADC counts of the chip's temperature sensor → °C, by the two points that the maker measured.

/// Temperatures of the maker's points, °C (DS8626, temperature sensor calibration values).
const COLD_C: f32 = 30.0;
const HOT_C: f32 = 110.0;
/// The supply voltage at which both were measured.
const CALIBRATION_SUPPLY_V: f32 = 3.3;
/// The typical sensor at that supply: 0.76 V at 25 °C and 2.5 mV/K (DS8626, temperature sensor characteristics).
const TYPICAL_COLD: f32 = counts(0.76 + (COLD_C - 25.0) * 0.002_5);
const TYPICAL_HOT: f32 = counts(0.76 + (HOT_C - 25.0) * 0.002_5);
/// Chips differ by up to 45 K (RM0090 13.10), which is 140 counts, and in the slope by a fifth at most.
const PLAUSIBLE_COLD: core::ops::RangeInclusive<f32> = TYPICAL_COLD - 140.0..=TYPICAL_COLD + 140.0;
const PLAUSIBLE_RISE: core::ops::RangeInclusive<f32> =
    (TYPICAL_HOT - TYPICAL_COLD) * 0.8..=(TYPICAL_HOT - TYPICAL_COLD) * 1.2;
/// Weight of a new reading in the smoothed counts. One count is 0.3 K.
const SHARE: f32 = 1.0 / 16.0;

const fn counts(volts: f32) -> f32 {
    volts / CALIBRATION_SUPPLY_V * 4_095.0
}

/// Measures the temperature of the chip.
///
/// ```
/// use robot_app::sensing::McuThermometer;
///
/// // This chip's words TS_CAL1 and TS_CAL2, at 30 and 110 °C.
/// let mut thermometer = McuThermometer::new(950, 1_200);
/// assert_eq!(thermometer.celsius(3.3), 0.0, "not measured yet");
/// thermometer.feed(Some(1_000));
/// assert_eq!(thermometer.celsius(3.3), 46.0);
/// ```
#[derive(Clone, Debug)]
pub struct McuThermometer {
    /// Counts at 30 °C and 3.3 V.
    cold: f32,
    /// Counts by which 110 °C lies above that.
    rise: f32,
    counts: Option<f32>,
}

impl McuThermometer {
    /// Takes the factory's words TS_CAL1 and TS_CAL2. If they are not plausible, the typical sensor replaces them.
    pub fn new(cold: u16, hot: u16) -> Self {
        let (cold, rise) = (f32::from(cold), f32::from(hot) - f32::from(cold));
        let plausible = PLAUSIBLE_COLD.contains(&cold) && PLAUSIBLE_RISE.contains(&rise);
        let (cold, rise) = if plausible {
            (cold, rise)
        } else {
            (TYPICAL_COLD, TYPICAL_HOT - TYPICAL_COLD)
        };
        Self {
            cold,
            rise,
            counts: None,
        }
    }

    /// Takes 12-bit counts of the sensor. `None` means that a conversion brought nothing.
    pub fn feed(&mut self, counts: Option<u16>) {
        if let Some(counts) = counts.map(f32::from) {
            let before = self.counts.unwrap_or(counts);
            self.counts = Some(before + (counts - before) * SHARE);
        }
    }

    /// Temperature of the chip, °C; 0 until it was measured. `supply_v` is the full scale of the ADC.
    pub fn celsius(&self, supply_v: f32) -> f32 {
        let Some(counts) = self.counts else {
            return 0.0;
        };
        let at_calibration = counts * (supply_v / CALIBRATION_SUPPLY_V);
        COLD_C + (at_calibration - self.cold) * ((HOT_C - COLD_C) / self.rise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn celsius(words: (u16, u16), counts: u16, supply_v: f32) -> f32 {
        let mut thermometer = McuThermometer::new(words.0, words.1);
        thermometer.feed(Some(counts));
        thermometer.celsius(supply_v)
    }

    /// 0.76 V are 943 counts at 3.3 V, and 2.5 mV are 3.1. Words that cannot be right are replaced by these values.
    #[test]
    fn the_typical_sensor_is_that_of_the_datasheet() {
        for words in [(0, 0), (u16::MAX, u16::MAX), (1_207, 959), (959, 959)] {
            for (counts, expected) in [(943, 25.0), (819, -15.0), (1_191, 105.0)] {
                let found = celsius(words, counts, 3.3);
                assert!((found - expected).abs() < 0.2, "{words:?}: {found} °C");
            }
        }
    }

    #[test]
    fn the_makers_points_are_met() {
        for words in [(959, 1_207), (830, 1_070), (1_090, 1_360)] {
            assert!((celsius(words, words.0, 3.3) - 30.0).abs() < 1e-3);
            assert!((celsius(words, words.1, 3.3) - 110.0).abs() < 1e-3);
        }
    }

    /// At 3.4 V all counts are 3 % lower, at 3.2 V 3 % higher.
    #[test]
    fn the_supply_is_corrected() {
        for (supply_v, counts) in [(3.2, 1_055), (3.4, 993)] {
            let found = celsius((959, 1_207), counts, supply_v);
            assert!((found - 50.6).abs() < 0.3, "{found} °C");
        }
    }

    #[test]
    fn the_first_reading_counts_in_full_and_later_ones_are_smoothed() {
        let mut thermometer = McuThermometer::new(959, 1_207);
        thermometer.feed(None);
        assert_eq!(thermometer.celsius(3.3), 0.0);
        thermometer.feed(Some(959));
        assert_eq!(thermometer.celsius(3.3), 30.0);
        thermometer.feed(Some(1_207));
        assert_eq!(thermometer.celsius(3.3), 35.0);
        thermometer.feed(None);
        assert_eq!(thermometer.celsius(3.3), 35.0);
    }
}
