//! ADC1 and ADC3 with the registers common to the three converters (RM0090 chapter 13): single conversions of
//! IN8, of the temperature sensor and of the internal reference voltage.
//!
//! VBAT is not modelled: VBATE stops the run. On the STM32F40x it has a channel of its own, IN18, and takes nothing from
//! the temperature sensor (RM0090 13.11).

mod converter;

use std::ops::Range;

use crate::{
    soc::{
        access::Access,
        dma_request::DmaRequest,
        peripheral::{Ctx, Peripheral, Unmodelled},
        registers::registers,
    },
    time::{Ps, US},
};
use converter::Converter;

registers! {
    CSR = 0x300,
    CCR = 0x304,
}

/// The registers of ADC1 and ADC3.
const ADC1: Range<u32> = 0x000..0x100;
const ADC3: Range<u32> = 0x200..0x300;

const IRQ: u8 = 18;
const MAX_ADC_HZ: u32 = 36_000_000;
/// Internal reference voltage of this chip. The datasheet allows 1.18 to 1.24 V.
const VREFINT_V: f64 = 1.217;
/// The reference and the temperature sensor after TSVREFE (DS8626, embedded reference voltage and temperature sensor
/// characteristics).
const INTERNAL_START: Ps = 10 * US;
/// Output of the temperature sensor at 25 °C, and its slope in V/K (DS8626, temperature sensor characteristics, typical).
const TEMPERATURE_V25: f64 = 0.76;
const TEMPERATURE_SLOPE: f64 = 2.5e-3;

/// The internal reference in counts of 12 bits at a supply of `vdda_v`.
pub fn vrefint_counts(vdda_v: f64) -> u16 {
    (VREFINT_V / vdda_v * 4095.0).round() as u16
}

/// The temperature sensor in counts of 12 bits at a supply of 3.3 V, as the maker calibrates it.
pub fn temperature_counts(celsius: f64) -> u16 {
    (temperature_v(celsius) / 3.3 * 4095.0).round() as u16
}

fn temperature_v(celsius: f64) -> f64 {
    TEMPERATURE_V25 + TEMPERATURE_SLOPE * (celsius - 25.0)
}

mod ccr {
    pub const ADCPRE: u32 = 3 << 16;
    pub const TSVREFE: u32 = 1 << 23;
}

/// Registers that the converters share.
#[derive(Debug, Default)]
struct Common {
    ccr: u32,
    internal_on_at: Ps,
}

impl Common {
    fn clock_hz(&self, ctx: &Ctx<'_>) -> u32 {
        ctx.clocks.pclk2_hz / (2 * ((self.ccr >> 16 & 3) + 1))
    }

    /// Whether a converter can measure the reference or the temperature sensor. If not, a board error is reported.
    fn internal_is_on(&self, source: &str, ctx: &mut Ctx<'_>) -> bool {
        if self.ccr & ccr::TSVREFE == 0 {
            let what = format!("ADC: {source} converted while TSVREFE is 0: it is not connected");
            ctx.errors.report(ctx.now, what);
            return false;
        }
        if ctx.now < self.internal_on_at {
            let what =
                format!("ADC: {source} converted less than 10 us after TSVREFE: it is not settled");
            ctx.errors.suspect(ctx.now, what);
        }
        true
    }

    fn write(&mut self, value: u32, ctx: &Ctx<'_>) -> Result<(), Unmodelled> {
        if value & !(ccr::ADCPRE | ccr::TSVREFE) != 0 {
            return Err(reg::MAP.unmodelled_write("ADC", reg::CCR, value));
        }
        if value & !self.ccr & ccr::TSVREFE != 0 {
            self.internal_on_at = ctx.now + INTERNAL_START;
        }
        self.ccr = value;
        Ok(())
    }
}

/// The ADC block: ADC1 at 0, ADC3 at 0x200, the common registers at 0x300.
#[derive(Debug)]
pub struct Adc {
    adc1: Converter,
    adc3: Converter,
    common: Common,
}

impl Adc {
    pub fn new() -> Self {
        Self {
            adc1: Converter::new(0),
            adc3: Converter::new(2),
            common: Common::default(),
        }
    }

    fn update_lines(&self, ctx: &mut Ctx<'_>) {
        let interrupt = self.adc1.wants_interrupt() || self.adc3.wants_interrupt();
        ctx.irq.set(IRQ, interrupt);
        ctx.dma.set(DmaRequest::Adc3, self.adc3.wants_dma());
    }
}

impl Peripheral for Adc {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let (access, own) = (Access::new(offset, size), Access::new(offset & 0xFF, size));
        let value = match access.register {
            register if ADC1.contains(&register) => self.adc1.read(own)?,
            register if ADC3.contains(&register) => self.adc3.read(own)?,
            // CSR shows the three status registers side by side.
            reg::CSR => self.adc1.status() | self.adc3.status() << 16,
            reg::CCR => self.common.ccr,
            other => return Err(reg::MAP.unmodelled_read("ADC", other)),
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
        let (access, own) = (Access::new(offset, size), Access::new(offset & 0xFF, size));
        match access.register {
            register if ADC1.contains(&register) => {
                self.adc1.write(own, value, &self.common, ctx)?
            }
            register if ADC3.contains(&register) => {
                self.adc3.write(own, value, &self.common, ctx)?
            }
            reg::CCR => {
                let value = access.written_over(self.common.ccr, value);
                self.common.write(value, ctx)?;
            }
            other => return Err(reg::MAP.unmodelled_write("ADC", other, value)),
        }
        self.update_lines(ctx);
        Ok(())
    }

    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>) {
        if tag == 0 {
            self.adc1.event(&self.common, ctx);
        } else {
            self.adc3.event(&self.common, ctx);
        }
        self.update_lines(ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self::new();
        self.update_lines(ctx);
    }
}

#[cfg(test)]
mod tests;
