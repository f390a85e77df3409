//! Flash interface: wait states and caches (RM0090 3.9). Programming and erasing are not modelled.

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
};

const LATENCY: u32 = 0x7;
const ICEN_DCEN: u32 = 0x600;
const RESET_CACHES: u32 = 0x1800;
const ACR: u32 = LATENCY | 0x100 | ICEN_DCEN | RESET_CACHES;

/// One wait state each 30 MHz at 2.7–3.6 V (RM0090 table 10).
const HZ_PER_WAIT_STATE: u32 = 30_000_000;

#[derive(Debug, Default)]
pub struct Flash {
    acr: u32,
}

impl Flash {
    /// Files a board error where `hclk_hz` asks for more wait states than set.
    pub fn check_speed(&self, ctx: &mut Ctx<'_>) {
        let needed = ctx
            .clocks
            .hclk_hz
            .div_ceil(HZ_PER_WAIT_STATE)
            .saturating_sub(1);
        let set = self.acr & LATENCY;
        if set < needed {
            let hclk_hz = ctx.clocks.hclk_hz;
            ctx.errors.report(
                ctx.now,
                format!("FLASH: {set} wait states at HCLK {hclk_hz} Hz, needs {needed}: fetches return garbage"),
            );
        }
    }
}

impl Peripheral for Flash {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            0x00 => Ok(access.read_of(self.acr)),
            _ => Err(unmodelled(offset, "read")),
        }
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        if access.register != 0 {
            return Err(unmodelled(offset, &format!("write of {value:#010x}")));
        }
        let whole = access.written_over(self.acr, value) & ACR;
        if whole & RESET_CACHES != 0 && self.acr & ICEN_DCEN != 0 {
            ctx.errors.report(
                ctx.now,
                "FLASH: ACR cache reset while the caches are on: ignored",
            );
        }
        self.acr = whole;
        self.check_speed(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        *self = Self::default();
    }
}

fn unmodelled(offset: u32, what: &str) -> Unmodelled {
    let names = ["ACR", "KEYR", "OPTKEYR", "SR", "CR", "OPTCR"];
    let register = names.get((offset / 4) as usize).map_or_else(
        || format!("FLASH+{offset:#x}"),
        |name| format!("FLASH.{name}"),
    );
    Unmodelled {
        register,
        what: what.to_owned(),
    }
}
