//! PWR: regulator scale and the lock of the backup domain (RM0090 5.4).

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
};

const DBP: u32 = 1 << 8;
const VOS: u32 = 1 << 14;
/// Second scale bit of the F42x; reserved here, and written by drivers that serve both.
const RESERVED_VOS: u32 = 1 << 15;
/// Read-only: the regulator has reached its scale.
const VOSRDY: u32 = 1 << 14;

#[derive(Debug)]
pub struct Pwr {
    cr: u32,
}

impl Default for Pwr {
    fn default() -> Self {
        Self { cr: VOS }
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

    /// True while RCC_BDCR may be written.
    pub fn backup_unlocked(&self) -> bool {
        self.cr & DBP != 0
    }
}

impl Peripheral for Pwr {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            0x00 => Ok(access.read_of(self.cr)),
            0x04 => Ok(access.read_of(VOSRDY)),
            _ => Err(unmodelled(offset, "read")),
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
        if access.register != 0 || whole & !(DBP | VOS | RESERVED_VOS) != 0 {
            return Err(unmodelled(offset, &format!("write of {value:#010x}")));
        }
        self.cr = whole & !RESERVED_VOS;
        Ok(())
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        *self = Self::default();
    }
}

fn unmodelled(offset: u32, what: &str) -> Unmodelled {
    let register = match offset & !3 {
        0x00 => "PWR.CR".to_owned(),
        0x04 => "PWR.CSR".to_owned(),
        other => format!("PWR+{other:#x}"),
    };
    Unmodelled {
        register,
        what: what.to_owned(),
    }
}
