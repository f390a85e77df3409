//! CAN_BTR: bit rate, sample point and test modes (RM0090 32.7.7, 32.9.2).

use std::ops::RangeInclusive;

use crate::{soc::clocks::cycles_to_ps, time::Ps};

/// Bit rate of the nodes on both buses.
pub const BUS_HZ: u32 = 1_000_000;

/// Sample points at 1 Mbit/s with which devices of different makers understand each other, in per mille of the bit
/// (table of recommended bit timings, CANpie; CiA recommends 875).
const RECOMMENDED_PERMILLE: RangeInclusive<u32> = 750..=900;
/// Earlier, the acknowledge of a node with slow transceivers has not arrived: twice 250 ns from TXD to RXD (TJA1051
/// datasheet, dynamic characteristics), a few metres of cable and the quantum by which the bits may be out of step.
/// Later than recommended nothing works for sure either: a recessive bit comes out of the receiver up to 100 ns short
/// (the same table, bit time on pin RXD).
const EARLIEST_PERMILLE: u32 = 600;

/// BTR and the values computed from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitTiming(pub u32);

impl BitTiming {
    /// TS1 = 3, TS2 = 2, SJW = 1, BRP = 0.
    pub const RESET: Self = Self(0x0123_0000);

    fn quanta_before_sample(self) -> u32 {
        2 + (self.0 >> 16 & 0xF)
    }

    fn quanta_after_sample(self) -> u32 {
        1 + (self.0 >> 20 & 7)
    }

    fn jump_width(self) -> u32 {
        1 + (self.0 >> 24 & 3)
    }

    fn quanta(self) -> u32 {
        self.quanta_before_sample() + self.quanta_after_sample()
    }

    fn sample_permille(self) -> u32 {
        1000 * self.quanta_before_sample() / self.quanta()
    }

    fn clocks_per_bit(self) -> u32 {
        ((self.0 & 0x3FF) + 1) * self.quanta()
    }

    pub fn bit(self, pclk1_hz: u32) -> Ps {
        cycles_to_ps(u64::from(self.clocks_per_bit()), pclk1_hz)
    }

    pub fn bits_per_second(self, pclk1_hz: u32) -> u32 {
        pclk1_hz / self.clocks_per_bit()
    }

    /// Whether it receives but never drives the bus.
    pub fn silent(self) -> bool {
        self.0 >> 31 == 1
    }

    /// Why this timing cannot talk to nodes at `BUS_HZ`: their clocks and the resynchronisation forgive 0.5 %, the
    /// sample must fall after the edges of the farthest node and before the next bit, and a resynchronisation must not
    /// jump over the end of the bit (ISO 11898-1: the jump width is at most phase segment 2).
    pub fn misfit(self, pclk1_hz: u32) -> Option<String> {
        let rate = self.bits_per_second(pclk1_hz);
        let sample = self.sample_permille();
        let (jump, after) = (self.jump_width(), self.quanta_after_sample());
        if rate.abs_diff(BUS_HZ) > BUS_HZ / 200 {
            Some(format!("{rate} bit/s on a {BUS_HZ} bit/s bus"))
        } else if sample < EARLIEST_PERMILLE || sample > *RECOMMENDED_PERMILLE.end() {
            Some(sample_text(sample))
        } else if jump > after {
            Some(format!(
                "SJW of {jump} quanta, with {after} after the sample"
            ))
        } else {
            None
        }
    }

    /// The reason why this timing is not recommended, if it is not.
    pub fn suspicion(self) -> Option<String> {
        let sample = self.sample_permille();
        (!RECOMMENDED_PERMILLE.contains(&sample)).then(|| sample_text(sample))
    }
}

fn sample_text(permille: u32) -> String {
    let percent = f64::from(permille) / 10.0;
    let (from, to) = RECOMMENDED_PERMILLE.into_inner();
    format!(
        "samples at {percent:.1} % of the bit, others at {} to {} %",
        from / 10,
        to / 10
    )
}

#[cfg(test)]
mod tests {
    use crate::time::US;

    use super::*;

    #[test]
    fn timings_of_one_megabit_fit_the_bus() {
        // docs/hardware.md#can-bit-timing: 42 MHz, prescaler 3, 10 + 3 quanta; prescaler 6, 5 + 1 quanta.
        for btr in [0x0029_0002, 0x0004_0005] {
            let timing = BitTiming(btr);
            assert_eq!(timing.suspicion(), None);
            assert_eq!(timing.bits_per_second(42_000_000), 1_000_000);
            assert_eq!(timing.bit(42_000_000), US);
            assert_eq!(timing.misfit(42_000_000), None);
        }
    }

    #[test]
    fn a_wrong_prescaler_or_clock_is_named() {
        let halved = BitTiming(0x0029_0005).misfit(42_000_000);
        assert_eq!(
            halved.as_deref(),
            Some("500000 bit/s on a 1000000 bit/s bus")
        );
        assert!(BitTiming(0x0029_0002).misfit(45_000_000).is_some());
        // 1 + 1 quanta before the sample, 8 after it; 4 clocks a quantum.
        let early = BitTiming(0x0070_0003).misfit(40_000_000);
        assert!(early.is_some_and(|why| why.starts_with("samples at 20.0 % of the bit")));
    }

    /// 14 quanta at 42 MHz / 3: TS1 + TS2 = 13.
    fn timing(ts1: u32, ts2: u32, sjw: u32) -> BitTiming {
        BitTiming((sjw - 1) << 24 | (ts2 - 1) << 20 | (ts1 - 1) << 16 | 2)
    }

    #[test]
    fn sample_points_beside_those_of_others() {
        for (ts1, ts2, fits, advised) in [
            (7, 6, false, false),  // 57 %
            (8, 5, true, false),   // 64 %
            (9, 4, true, false),   // 71 %
            (10, 3, true, true),   // 79 %
            (11, 2, true, true),   // 86 %
            (12, 1, false, false), // 93 %
        ] {
            let timing = timing(ts1, ts2, 1);
            assert_eq!(timing.misfit(42_000_000).is_none(), fits, "{ts1} + {ts2}");
            assert_eq!(timing.suspicion().is_none(), advised, "{ts1} + {ts2}");
        }
    }

    #[test]
    fn a_jump_past_the_end_of_the_bit_is_named() {
        assert_eq!(timing(10, 3, 3).misfit(42_000_000), None);
        let why = timing(10, 3, 4).misfit(42_000_000);
        assert_eq!(
            why.as_deref(),
            Some("SJW of 4 quanta, with 3 after the sample")
        );
    }
}
