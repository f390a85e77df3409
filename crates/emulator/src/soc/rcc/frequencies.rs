//! Computes frequencies from register values, and reports settings that RM0090 7.3 and datasheet table 14 forbid.

pub const HSI_HZ: u32 = 16_000_000;

/// Source of SYSCLK (CFGR.SW).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemClock {
    Hsi,
    Hse,
    Pll,
}

impl SystemClock {
    /// `None` for the value 3, which RM0090 does not allow.
    pub fn from_sw(sw: u32) -> Option<Self> {
        match sw & 3 {
            0 => Some(Self::Hsi),
            1 => Some(Self::Hse),
            2 => Some(Self::Pll),
            _ => None,
        }
    }

    pub fn sws(self) -> u32 {
        self as u32
    }
}

/// PLLCFGR.PLLSRC: whether the PLL runs from the crystal, not from the HSI.
pub fn uses_hse(pllcfgr: u32) -> bool {
    pllcfgr >> 22 & 1 == 1
}

/// The fields of PLLCFGR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pll {
    m: u32,
    n: u32,
    p: u32,
    q: u32,
    input_hz: u32,
}

impl Pll {
    /// `hse_hz` is the board's crystal.
    pub fn from_pllcfgr(value: u32, hse_hz: u32) -> Self {
        Self {
            m: value & 0x3F,
            n: value >> 6 & 0x1FF,
            p: 2 * ((value >> 16 & 3) + 1),
            q: value >> 24 & 0xF,
            input_hz: if uses_hse(value) { hse_hz } else { HSI_HZ },
        }
    }

    fn vco_hz(self) -> u64 {
        u64::from(self.input_hz) * u64::from(self.n) / u64::from(self.m.max(1))
    }

    /// Output P, which may become SYSCLK.
    pub fn output_hz(self) -> u32 {
        (self.vco_hz() / u64::from(self.p)).min(u64::from(u32::MAX)) as u32
    }

    /// Reasons why this setting does not work on silicon.
    pub fn problems(self) -> Vec<String> {
        let vco_in_khz = self.input_hz / 1000 / self.m.max(1);
        let vco_mhz = self.vco_hz() / 1_000_000;
        let mut problems = Vec::new();
        if self.m < 2 || !(950..=2100).contains(&vco_in_khz) {
            problems.push(format!(
                "RCC: PLLM = {} gives a VCO input of {vco_in_khz} kHz, must be 0.95 to 2.1 MHz",
                self.m
            ));
        }
        if !(50..=432).contains(&self.n) || !(100..=432).contains(&vco_mhz) {
            problems.push(format!(
                "RCC: PLLN = {} gives a VCO of {vco_mhz} MHz, must be 100 to 432 MHz",
                self.n
            ));
        }
        if self.q < 2 {
            problems.push(format!(
                "RCC: PLLQ = {} is not allowed, must be 2 to 15",
                self.q
            ));
        }
        problems
    }
}

/// Frequencies behind the AHB and APB prescalers, Hz.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BusClocks {
    pub hclk_hz: u32,
    pub pclk1_hz: u32,
    pub pclk2_hz: u32,
    pub tim1_hz: u32,
    pub tim2_hz: u32,
}

impl BusClocks {
    pub fn new(sysclk_hz: u32, cfgr: u32) -> Self {
        let hclk_hz = sysclk_hz / ahb_divider(cfgr >> 4 & 0xF);
        let (pclk1_hz, tim1_hz) = apb(hclk_hz, cfgr >> 10 & 7);
        let (pclk2_hz, tim2_hz) = apb(hclk_hz, cfgr >> 13 & 7);
        Self {
            hclk_hz,
            pclk1_hz,
            pclk2_hz,
            tim1_hz,
            tim2_hz,
        }
    }

    pub fn problems(self) -> Vec<String> {
        [
            ("HCLK", self.hclk_hz, 168),
            ("PCLK1", self.pclk1_hz, 42),
            ("PCLK2", self.pclk2_hz, 84),
        ]
        .into_iter()
        .filter(|(_, hz, max_mhz)| *hz > max_mhz * 1_000_000)
        .map(|(name, hz, max_mhz)| {
            format!("RCC: {name} is {hz} Hz, more than the {max_mhz} MHz allowed")
        })
        .collect()
    }
}

/// HPRE (RM0090 7.3.3): there is no division by 32.
fn ahb_divider(hpre: u32) -> u32 {
    match hpre {
        0..=7 => 1,
        8..=11 => 2 << (hpre - 8),
        _ => 64 << (hpre - 12),
    }
}

/// Bus and timer clock behind PPREx.
fn apb(hclk_hz: u32, ppre: u32) -> (u32, u32) {
    match ppre {
        0..=3 => (hclk_hz, hclk_hz),
        _ => {
            let pclk = hclk_hz / (2 << (ppre - 4));
            (pclk, 2 * pclk)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CRYSTAL_HZ: u32 = 12_000_000;

    fn pllcfgr(m: u32, n: u32, p: u32, q: u32) -> u32 {
        m | n << 6 | (p / 2 - 1) << 16 | 1 << 22 | q << 24
    }

    #[test]
    fn both_settings_found_on_c_boards_give_168_mhz() {
        for value in [pllcfgr(6, 168, 2, 7), pllcfgr(12, 336, 2, 7)] {
            let pll = Pll::from_pllcfgr(value, CRYSTAL_HZ);
            assert_eq!(pll.output_hz(), 168_000_000);
            assert_eq!(pll.problems(), Vec::<String>::new());
        }
    }

    #[test]
    fn a_pll_out_of_its_range_is_named() {
        // 12 MHz / 4 = 3 MHz into the VCO.
        assert!(
            Pll::from_pllcfgr(pllcfgr(4, 112, 2, 7), CRYSTAL_HZ).problems()[0].contains("3000 kHz")
        );
        // 2 MHz × 300 = 600 MHz.
        assert!(
            Pll::from_pllcfgr(pllcfgr(6, 300, 2, 7), CRYSTAL_HZ).problems()[0].contains("600 MHz")
        );
    }

    #[test]
    fn prescalers_follow_the_reference_manual() {
        // HPRE 0xxx = /1, 1000 = /2, 1011 = /16, 1100 = /64, 1111 = /512.
        let dividers = [0, 7, 8, 11, 12, 15].map(ahb_divider);
        assert_eq!(dividers, [1, 1, 2, 16, 64, 512]);
        // PPRE1 = 101 (/4), PPRE2 = 100 (/2).
        let clocks = BusClocks::new(168_000_000, 0b101 << 10 | 0b100 << 13);
        assert_eq!((clocks.pclk1_hz, clocks.tim1_hz), (42_000_000, 84_000_000));
        assert_eq!((clocks.pclk2_hz, clocks.tim2_hz), (84_000_000, 168_000_000));
        assert!(clocks.problems().is_empty());
        // PPRE1 = /2: 84 MHz on a 42 MHz bus.
        let too_fast = BusClocks::new(168_000_000, 0b100 << 10 | 0b100 << 13);
        assert!(too_fast.problems()[0].contains("PCLK1"));
    }
}
