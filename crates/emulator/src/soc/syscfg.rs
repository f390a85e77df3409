//! SYSCFG: which port feeds each EXTI line (RM0090 9.2).

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
    pins::Pin,
    registers::registers,
};

registers! {
    MEMRMP = 0x00,
    PMC = 0x04,
    EXTICR1 = 0x08,
    EXTICR2 = 0x0C,
    EXTICR3 = 0x10,
    EXTICR4 = 0x14,
    CMPCR = 0x20,
}

#[derive(Debug, Default)]
pub struct Syscfg {
    exticr: [u32; 4],
}

impl Syscfg {
    /// The pin behind an EXTI line 0–15.
    pub fn exti_source(&self, line: u8) -> Pin {
        let port = self.exticr[usize::from(line / 4)] >> (4 * u32::from(line % 4)) & 0xF;
        Pin {
            port: (port as u8).min(8),
            number: line,
        }
    }
}

impl Peripheral for Syscfg {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            // MEMRMP: started from flash.
            reg::MEMRMP => Ok(0),
            reg::EXTICR1..=reg::EXTICR4 => {
                Ok(access.read_of(self.exticr[(access.register - reg::EXTICR1) as usize / 4]))
            }
            _ => Err(reg::MAP.unmodelled_read("SYSCFG", offset)),
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
        match access.register {
            reg::EXTICR1..=reg::EXTICR4 => {
                let exticr = &mut self.exticr[(access.register - reg::EXTICR1) as usize / 4];
                *exticr = access.written_over(*exticr, value) & 0xFFFF;
                Ok(())
            }
            _ => Err(reg::MAP.unmodelled_write("SYSCFG", offset, value)),
        }
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        *self = Self::default();
    }
}
