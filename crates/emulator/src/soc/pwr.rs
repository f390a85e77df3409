//! PWR: regulator scale, voltage detector and the lock of the backup domain (RM0090 5.2.3, 5.4).

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
    registers::registers,
};

registers! {
    CR = 0x00,
    CSR = 0x04,
}

const PVDE: u32 = 1 << 4;
const PLS_SHIFT: u32 = 5;
const PLS: u32 = 7 << PLS_SHIFT;
const DBP: u32 = 1 << 8;
const VOS: u32 = 1 << 14;
/// Second scale bit of the F42x; reserved here, and written by drivers that serve both.
const RESERVED_VOS: u32 = 1 << 15;
/// Read-only: the regulator has reached its scale.
const VOSRDY: u32 = 1 << 14;
/// Read-only: VDD is below the level of PLS.
const PVDO: u32 = 1 << 2;
/// Nominal levels of PLS 0 to 7.
const PVD_LEVELS_MV: [u32; 8] = [2_000, 2_100, 2_300, 2_500, 2_600, 2_700, 2_800, 2_900];
/// Supply at power-on.
const VDD_MV: u32 = 3_300;

#[derive(Debug)]
pub struct Pwr {
    cr: u32,
    vdd_mv: u32,
}

impl Default for Pwr {
    fn default() -> Self {
        Self {
            cr: VOS,
            vdd_mv: VDD_MV,
        }
    }
}

impl Pwr {
    /// Highest HCLK of the regulator's scale, Hz (datasheet table 14).
    pub fn max_hclk_hz(&self) -> u32 {
        if self.cr & VOS != 0 {
            168_000_000
        } else {
            144_000_000
        }
    }

    pub fn set_vdd_mv(&mut self, vdd_mv: u32) {
        self.vdd_mv = vdd_mv;
    }

    fn status(&self) -> u32 {
        let level_mv = PVD_LEVELS_MV[((self.cr & PLS) >> PLS_SHIFT) as usize];
        if self.cr & PVDE != 0 && self.vdd_mv < level_mv {
            VOSRDY | PVDO
        } else {
            VOSRDY
        }
    }

    /// True while RCC_BDCR may be written.
    pub fn backup_unlocked(&self) -> bool {
        self.cr & DBP != 0
    }
}

impl Peripheral for Pwr {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            reg::CR => Ok(access.read_of(self.cr)),
            reg::CSR => Ok(access.read_of(self.status())),
            _ => Err(reg::MAP.unmodelled_read("PWR", offset)),
        }
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        _ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let whole = access.written_over(self.cr, value);
        if access.register != reg::CR || whole & !(PVDE | PLS | DBP | VOS | RESERVED_VOS) != 0 {
            return Err(reg::MAP.unmodelled_write("PWR", offset, value));
        }
        self.cr = whole & !RESERVED_VOS;
        Ok(())
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        self.cr = Self::default().cr;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soc::test_bench::Bench;

    /// RM0090 5.4.1: level 7 is 2.9 V, level 0 is 2.0 V.
    #[test]
    fn the_detector_compares_the_supply_with_its_level_while_it_is_on() {
        let mut bench = Bench::new();
        let mut pwr = Pwr::default();
        for (cr, vdd_mv, low) in [
            (VOS | 0xF0, 3_300, false),
            (VOS | 0xF0, 2_899, true),
            (VOS | 0xF0, 2_900, false),
            (VOS | 0xE0, 1_900, false),
            (VOS | 0x10, 2_000, false),
            (VOS | 0x10, 1_999, true),
        ] {
            bench.write(&mut pwr, 0, cr);
            pwr.set_vdd_mv(vdd_mv);
            let csr = bench.read(&mut pwr, 4);
            assert_eq!(csr & 1 << 2 != 0, low, "{cr:#x} {vdd_mv} mV");
        }
        // A reset changes the registers, not the supply.
        bench.write(&mut pwr, 0, VOS);
        pwr.reset(&mut bench.ctx());
        bench.write(&mut pwr, 0, VOS | 0x10);
        assert_eq!(bench.read(&mut pwr, 4) & 1 << 2, 1 << 2);
    }
}
