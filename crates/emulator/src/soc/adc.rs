//! ADC3 with the registers common to the three converters (RM0090 chapter 13): single conversions of the battery.

use robot_plant::time::{Ps, US};

use crate::{
    soc::{
        access::Access,
        clocks::cycles_to_ps,
        dma_request::DmaRequest,
        peripheral::{Ctx, Peripheral, Unmodelled},
        scheduler::Target,
    },
    wiring::{self, Signal},
};

const IRQ: u8 = 18;
/// PF10 on the C board.
const BATTERY_CHANNEL: u32 = 8;
/// VREF+ is tied to the 3.3 V supply.
const REFERENCE_V: f64 = 3.3;
/// tSTAB after ADON (DS8626 table 67).
const STABLE_AFTER: Ps = 3 * US;
const MAX_ADC_HZ: u32 = 36_000_000;

mod sr {
    pub const EOC: u32 = 1 << 1;
    pub const STRT: u32 = 1 << 4;
    pub const OVR: u32 = 1 << 5;
    pub const ALL: u32 = 0x3F;
}

mod cr1 {
    pub const EOCIE: u32 = 1 << 5;
    pub const OVRIE: u32 = 1 << 26;
    /// SCAN changes nothing in a sequence of one.
    pub const SCAN: u32 = 1 << 8;
    pub const RES: u32 = 3 << 24;
}

mod cr2 {
    pub const ADON: u32 = 1;
    pub const DMA: u32 = 1 << 8;
    pub const DDS: u32 = 1 << 9;
    pub const EOCS: u32 = 1 << 10;
    pub const ALIGN: u32 = 1 << 11;
    pub const SWSTART: u32 = 1 << 30;
    pub const MODELLED: u32 = ADON | DMA | DDS | EOCS | ALIGN | SWSTART;
}

/// ADC3 at 0x200 and the common registers at 0x300 of the ADC block.
#[derive(Debug, Default)]
pub struct Adc {
    sr: u32,
    cr1: u32,
    cr2: u32,
    smpr1: u32,
    smpr2: u32,
    sqr: [u32; 3],
    dr: u32,
    ccr: u32,
    stable_at: Ps,
    ends_at: Option<Ps>,
}

impl Adc {
    pub fn new() -> Self {
        Self::default()
    }

    fn clock_hz(&self, ctx: &Ctx<'_>) -> u32 {
        ctx.clocks.pclk2_hz / (2 * ((self.ccr >> 16 & 3) + 1))
    }

    fn channel(&self) -> u32 {
        self.sqr[2] & 0x1F
    }

    /// 12, 10, 8 or 6.
    fn resolution_bits(&self) -> u32 {
        12 - 2 * (self.cr1 >> 24 & 3)
    }

    fn sample_cycles(&self) -> u64 {
        const CYCLES: [u64; 8] = [3, 15, 28, 56, 84, 112, 144, 480];
        let channel = self.channel();
        let field = if channel < 10 {
            self.smpr2 >> (3 * channel)
        } else {
            self.smpr1 >> (3 * (channel - 10))
        };
        CYCLES[(field & 7) as usize]
    }

    fn start(&mut self, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if self.cr2 & cr2::ADON == 0 {
            ctx.errors
                .report(ctx.now, "ADC3: SWSTART while ADON is 0: no conversion");
            return Ok(());
        }
        if self.sqr[0] >> 20 & 0xF != 0 {
            return Err(unmodelled("SQR1", "a sequence of more than one conversion"));
        }
        if self.channel() != BATTERY_CHANNEL {
            return Err(unmodelled("SQR3", &format!("input IN{}", self.channel())));
        }
        if ctx.now < self.stable_at {
            ctx.errors.suspect(
                ctx.now,
                "ADC3: started less than 3 us after ADON: the result is not settled",
            );
        }
        let clock_hz = self.clock_hz(ctx);
        if clock_hz > MAX_ADC_HZ {
            ctx.errors.suspect(
                ctx.now,
                format!("ADC3: clocked at {clock_hz} Hz, the limit is {MAX_ADC_HZ} Hz"),
            );
        }
        let cycles = self.sample_cycles() + u64::from(self.resolution_bits());
        let at = ctx.now + cycles_to_ps(cycles, clock_hz);
        self.sr |= sr::STRT;
        self.ends_at = Some(at);
        ctx.scheduler.at(at, Target::Adc3, 0);
        Ok(())
    }

    fn convert(&self, ctx: &mut Ctx<'_>) -> u32 {
        let bits = self.resolution_bits();
        let volts = if wiring::check(Signal::Adc3In8, ctx) {
            ctx.world.battery_adc_volts()
        } else {
            0.0
        };
        let top = f64::from((1u32 << bits) - 1);
        let code = (volts / REFERENCE_V * f64::from(1u32 << bits))
            .floor()
            .clamp(0.0, top) as u32;
        match (self.cr2 & cr2::ALIGN != 0, bits) {
            (false, _) => code,
            // 6-bit results are left-aligned within a byte (RM0090 13.4).
            (true, 6) => code << 2,
            (true, _) => code << (16 - bits),
        }
    }

    fn write_cr2(&mut self, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if value & !cr2::MODELLED != 0 {
            return Err(unmodelled("CR2", &format!("write of {value:#010x}")));
        }
        let was_on = self.cr2 & cr2::ADON != 0;
        self.cr2 = value & !cr2::SWSTART;
        match (was_on, value & cr2::ADON != 0) {
            (false, true) => self.stable_at = ctx.now + STABLE_AFTER,
            (_, false) => self.ends_at = None,
            _ => {}
        }
        if value & cr2::SWSTART != 0 {
            self.start(ctx)
        } else {
            Ok(())
        }
    }

    fn update_lines(&self, ctx: &mut Ctx<'_>) {
        let irq = self.cr1 & cr1::EOCIE != 0 && self.sr & sr::EOC != 0
            || self.cr1 & cr1::OVRIE != 0 && self.sr & sr::OVR != 0;
        ctx.irq.set(IRQ, irq);
        ctx.dma.set(
            DmaRequest::Adc3,
            self.cr2 & cr2::DMA != 0 && self.sr & sr::EOC != 0,
        );
    }
}

impl Peripheral for Adc {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        let value = match access.register {
            0x200 => self.sr,
            0x204 => self.cr1,
            0x208 => self.cr2,
            0x20C => self.smpr1,
            0x210 => self.smpr2,
            0x22C..=0x234 => self.sqr[((access.register - 0x22C) / 4) as usize],
            0x24C => {
                self.sr &= !sr::EOC;
                self.dr
            }
            // CSR shows the three status registers side by side.
            0x300 => (self.sr & sr::ALL) << 16,
            0x304 => self.ccr,
            other => return Err(unmodelled(&format!("+{other:#x}"), "read")),
        };
        self.update_lines(ctx);
        Ok(access.read_of(value))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let over = |old| access.written_over(old, value);
        match access.register {
            // Every flag is cleared by writing 0.
            0x200 => self.sr &= over(u32::MAX),
            0x204 => {
                let value = over(self.cr1);
                if value & !(cr1::EOCIE | cr1::OVRIE | cr1::SCAN | cr1::RES) != 0 {
                    return Err(unmodelled("CR1", &format!("write of {value:#010x}")));
                }
                self.cr1 = value;
            }
            0x208 => self.write_cr2(over(self.cr2), ctx)?,
            0x20C => self.smpr1 = over(self.smpr1),
            0x210 => self.smpr2 = over(self.smpr2),
            0x22C..=0x234 => {
                let sqr = &mut self.sqr[((access.register - 0x22C) / 4) as usize];
                *sqr = over(*sqr);
            }
            0x304 if over(self.ccr) & !(3 << 16) == 0 => self.ccr = over(self.ccr),
            other => {
                return Err(unmodelled(
                    &format!("+{other:#x}"),
                    &format!("write of {value:#010x}"),
                ));
            }
        }
        self.update_lines(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, ctx: &mut Ctx<'_>) {
        if self.ends_at.is_none_or(|at| at > ctx.now) {
            return;
        }
        self.ends_at = None;
        if self.cr2 & (cr2::DMA | cr2::EOCS) != 0 && self.sr & sr::EOC != 0 {
            self.sr |= sr::OVR;
        } else {
            self.dr = self.convert(ctx);
            self.sr |= sr::EOC;
        }
        self.update_lines(ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self::new();
        self.update_lines(ctx);
    }
}

fn unmodelled(register: &str, what: &str) -> Unmodelled {
    Unmodelled {
        register: format!("ADC.{register}"),
        what: what.to_owned(),
    }
}

#[cfg(test)]
mod tests;
