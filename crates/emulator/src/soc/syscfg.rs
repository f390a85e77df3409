//! SYSCFG: which port feeds each EXTI line (RM0090 9.2).

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
    pins::Pin,
};

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
            0x00 => Ok(0),
            0x08..=0x14 => Ok(access.read_of(self.exticr[(access.register - 0x08) as usize / 4])),
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
        match access.register {
            0x08..=0x14 => {
                let exticr = &mut self.exticr[(access.register - 0x08) as usize / 4];
                *exticr = access.written_over(*exticr, value) & 0xFFFF;
                Ok(())
            }
            _ => Err(unmodelled(offset, &format!("write of {value:#010x}"))),
        }
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        *self = Self::default();
    }
}

fn unmodelled(offset: u32, what: &str) -> Unmodelled {
    let register = match offset & !3 {
        0x00 => "SYSCFG.MEMRMP".to_owned(),
        0x04 => "SYSCFG.PMC".to_owned(),
        0x20 => "SYSCFG.CMPCR".to_owned(),
        other => format!("SYSCFG+{other:#x}"),
    };
    Unmodelled {
        register,
        what: what.to_owned(),
    }
}
