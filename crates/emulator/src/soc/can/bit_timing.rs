//! CAN_BTR: bit rate, sample point and test modes (RM0090 32.7.7, 32.9.2).

use robot_plant::time::Ps;

use crate::soc::clocks::cycles_to_ps;

/// Rate of every device on the board's buses.
pub const BUS_HZ: u32 = 1_000_000;

/// BTR and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitTiming(pub u32);

impl BitTiming {
    /// TS1 = 3, TS2 = 2, SJW = 1, BRP = 0.
    pub const RESET: Self = Self(0x0123_0000);

    fn quanta_before_sample(self) -> u32 {
        2 + (self.0 >> 16 & 0xF)
    }

    fn quanta(self) -> u32 {
        self.quanta_before_sample() + 1 + (self.0 >> 20 & 7)
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

    /// Receives but never drives the bus.
    pub fn silent(self) -> bool {
        self.0 >> 31 == 1
    }

    /// Why this timing cannot talk to nodes at `BUS_HZ`: their clocks and the resynchronisation forgive 0.5 %, and
    /// the sample must fall after the edges of the farthest node and before the next bit.
    pub fn misfit(self, pclk1_hz: u32) -> Option<String> {
        let rate = self.bits_per_second(pclk1_hz);
        let sample_permille = 1000 * self.quanta_before_sample() / self.quanta();
        if rate.abs_diff(BUS_HZ) > BUS_HZ / 200 {
            Some(format!("{rate} bit/s on a {BUS_HZ} bit/s bus"))
        } else if !(500..=950).contains(&sample_permille) {
            Some(format!(
                "samples at {:.1} % of the bit",
                f64::from(sample_permille) / 10.0
            ))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use robot_plant::time::US;

    use super::*;

    #[test]
    fn the_timings_of_the_c_board_fit_the_bus() {
        // hardware.md 1.4: 42 MHz, prescaler 3, 10 + 3 quanta; prescaler 6, 5 + 1 quanta.
        for btr in [0x0029_0002, 0x0004_0005] {
            let timing = BitTiming(btr);
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
        assert_eq!(early.as_deref(), Some("samples at 20.0 % of the bit"));
    }
}
