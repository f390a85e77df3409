//! One converter: single conversions of one input, started by software.

use super::{Common, MAX_ADC_HZ, VREFINT_V, temperature_v};
use crate::{
    soc::{
        access::Access,
        clocks::cycles_to_ps,
        peripheral::{Ctx, Unmodelled},
        registers::registers,
        routing,
        scheduler::Target,
        signals::Signal,
    },
    time::{NS, Ps, SECOND, US},
};

/// tSTAB after ADON (DS8626, ADC characteristics).
const STABLE_AFTER: Ps = 3 * US;
/// Least sampling time of the internal reference and of the temperature sensor (DS8626, embedded reference voltage and
/// temperature sensor characteristics).
const INTERNAL_SAMPLING: Ps = 10 * US;
/// Resistance of the sampling switch, Ω, the capacitor it charges, F, and the time constants until 12 bits are right to
/// half a count (DS8626, ADC characteristics, equation for the external input impedance).
const SWITCH_OHMS: f64 = 6_000.0;
const SAMPLING_FARADS: f64 = 7e-12;
const TIME_CONSTANTS: f64 = 9.7;

registers! {
    SR = 0x00,
    CR1 = 0x04,
    CR2 = 0x08,
    SMPR1 = 0x0C,
    SMPR2 = 0x10,
    SQR1 = 0x2C,
    SQR2 = 0x30,
    SQR3 = 0x34,
    DR = 0x4C,
}

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

/// Source of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Input {
    /// ADC3_IN8.
    In8,
    /// ADC1_IN16.
    Temperature,
    /// ADC1_IN17.
    Vrefint,
}

impl Input {
    /// The name of a source within the chip.
    fn internal(self) -> Option<&'static str> {
        match self {
            Self::In8 => None,
            Self::Temperature => Some("the temperature sensor"),
            Self::Vrefint => Some("VREFINT"),
        }
    }
}

/// One converter; its registers lie at 0x100 times `index`.
#[derive(Debug, Default)]
pub struct Converter {
    index: u32,
    sr: u32,
    cr1: u32,
    cr2: u32,
    smpr1: u32,
    smpr2: u32,
    sqr: [u32; 3],
    dr: u32,
    stable_at: Ps,
    ends_at: Option<Ps>,
}

impl Converter {
    pub fn new(index: u32) -> Self {
        Self {
            index,
            ..Self::default()
        }
    }

    fn name(&self) -> String {
        format!("ADC{}", self.index + 1)
    }

    fn channel(&self) -> u32 {
        self.sqr[2] & 0x1F
    }

    fn input(&self) -> Option<Input> {
        match (self.index, self.channel()) {
            (2, 8) => Some(Input::In8),
            (0, 16) => Some(Input::Temperature),
            (0, 17) => Some(Input::Vrefint),
            _ => None,
        }
    }

    /// Resolution in bits: 12, 10, 8 or 6.
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

    fn start(&mut self, common: &Common, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        let name = self.name();
        if self.cr2 & cr2::ADON == 0 {
            let what = format!("{name}: SWSTART while ADON is 0: no conversion");
            ctx.errors.report(ctx.now, what);
            return Ok(());
        }
        if self.sqr[0] >> 20 & 0xF != 0 {
            return Err(reg::MAP.unmodelled(
                name,
                reg::SQR1,
                "a sequence of more than one conversion",
            ));
        }
        let Some(input) = self.input() else {
            return Err(reg::MAP.unmodelled(
                name,
                reg::SQR3,
                format!("input IN{}", self.channel()),
            ));
        };
        if ctx.now < self.stable_at {
            let what =
                format!("{name}: started less than 3 us after ADON: the result is not settled");
            ctx.errors.suspect(ctx.now, what);
        }
        let clock_hz = common.clock_hz(ctx);
        if clock_hz > MAX_ADC_HZ {
            let what = format!("{name}: clocked at {clock_hz} Hz, the limit is {MAX_ADC_HZ} Hz");
            ctx.errors.suspect(ctx.now, what);
        }
        let sampling = cycles_to_ps(self.sample_cycles(), clock_hz);
        if let Some(source) = input.internal().filter(|_| sampling < INTERNAL_SAMPLING) {
            let what =
                format!("{name}: {source} is sampled for less than 10 us: the result is too low");
            ctx.errors.suspect(ctx.now, what);
        }
        if input == Input::In8 {
            let source = ctx.board.analog(Signal::Adc3In8);
            let needed = TIME_CONSTANTS * (source.ohms + SWITCH_OHMS) * SAMPLING_FARADS;
            if sampling < (needed * SECOND as f64) as Ps {
                let (ns, ohms) = (sampling / NS, source.ohms);
                let what = format!(
                    "{name}: a source of {ohms:.0} ohms is sampled for {ns} ns: the result is too low"
                );
                ctx.errors.suspect(ctx.now, what);
            }
        }
        let at = ctx.now + sampling + cycles_to_ps(self.resolution_bits().into(), clock_hz);
        self.sr |= sr::STRT;
        self.ends_at = Some(at);
        ctx.scheduler.at(at, Target::Adc, self.index);
        Ok(())
    }

    fn convert(&self, common: &Common, ctx: &mut Ctx<'_>) -> u32 {
        let bits = self.resolution_bits();
        let input = self.input();
        let on = match input.and_then(Input::internal) {
            Some(source) => common.internal_is_on(source, ctx),
            None => true,
        };
        let volts = match input.filter(|_| on) {
            Some(Input::In8) if routing::check(Signal::Adc3In8, ctx) => {
                ctx.board.analog(Signal::Adc3In8).volts
            }
            Some(Input::Temperature) => temperature_v(ctx.board.chip_temperature_c()),
            Some(Input::Vrefint) => VREFINT_V,
            _ => 0.0,
        };
        let top = f64::from((1u32 << bits) - 1);
        let code = (volts / ctx.board.vdda_v() * f64::from(1u32 << bits))
            .floor()
            .clamp(0.0, top) as u32;
        match (self.cr2 & cr2::ALIGN != 0, bits) {
            (false, _) => code,
            // 6-bit results are left-aligned within a byte (RM0090 13.4).
            (true, 6) => code << 2,
            (true, _) => code << (16 - bits),
        }
    }

    fn write_cr2(
        &mut self,
        value: u32,
        common: &Common,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let dma = value & cr2::DMA != 0 && self.index != 2;
        if value & !cr2::MODELLED != 0 || dma {
            return Err(reg::MAP.unmodelled_write(self.name(), reg::CR2, value));
        }
        let was_on = self.cr2 & cr2::ADON != 0;
        self.cr2 = value & !cr2::SWSTART;
        match (was_on, value & cr2::ADON != 0) {
            (false, true) => self.stable_at = ctx.now + STABLE_AFTER,
            (_, false) => self.ends_at = None,
            _ => {}
        }
        if value & cr2::SWSTART != 0 {
            self.start(common, ctx)
        } else {
            Ok(())
        }
    }

    pub fn wants_interrupt(&self) -> bool {
        self.cr1 & cr1::EOCIE != 0 && self.sr & sr::EOC != 0
            || self.cr1 & cr1::OVRIE != 0 && self.sr & sr::OVR != 0
    }

    pub fn wants_dma(&self) -> bool {
        self.cr2 & cr2::DMA != 0 && self.sr & sr::EOC != 0
    }

    /// Status as shown in CSR.
    pub fn status(&self) -> u32 {
        self.sr & sr::ALL
    }

    /// The offset of `access` is relative to the converter's own registers.
    pub fn read(&mut self, access: Access) -> Result<u32, Unmodelled> {
        Ok(match access.register {
            reg::SR => self.sr,
            reg::CR1 => self.cr1,
            reg::CR2 => self.cr2,
            reg::SMPR1 => self.smpr1,
            reg::SMPR2 => self.smpr2,
            reg::SQR1..=reg::SQR3 => self.sqr[((access.register - reg::SQR1) / 4) as usize],
            reg::DR => {
                self.sr &= !sr::EOC;
                self.dr
            }
            other => return Err(reg::MAP.unmodelled_read(self.name(), other)),
        })
    }

    pub fn write(
        &mut self,
        access: Access,
        value: u32,
        common: &Common,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let over = |old| access.written_over(old, value);
        match access.register {
            // Every flag is cleared by writing 0.
            reg::SR => self.sr &= over(u32::MAX),
            reg::CR1 => {
                let value = over(self.cr1);
                if value & !(cr1::EOCIE | cr1::OVRIE | cr1::SCAN | cr1::RES) != 0 {
                    return Err(reg::MAP.unmodelled_write(self.name(), reg::CR1, value));
                }
                self.cr1 = value;
            }
            reg::CR2 => self.write_cr2(over(self.cr2), common, ctx)?,
            reg::SMPR1 => self.smpr1 = over(self.smpr1),
            reg::SMPR2 => self.smpr2 = over(self.smpr2),
            reg::SQR1..=reg::SQR3 => {
                let sqr = &mut self.sqr[((access.register - reg::SQR1) / 4) as usize];
                *sqr = over(*sqr);
            }
            other => return Err(reg::MAP.unmodelled_write(self.name(), other, value)),
        }
        Ok(())
    }

    /// Ends the conversion if its time is over.
    pub fn event(&mut self, common: &Common, ctx: &mut Ctx<'_>) {
        if self.ends_at.is_none_or(|at| at > ctx.now) {
            return;
        }
        self.ends_at = None;
        if self.cr2 & (cr2::DMA | cr2::EOCS) != 0 && self.sr & sr::EOC != 0 {
            self.sr |= sr::OVR;
        } else {
            self.dr = self.convert(common, ctx);
            self.sr |= sr::EOC;
        }
    }
}
