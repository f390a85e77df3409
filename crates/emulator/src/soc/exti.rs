//! EXTI: edges of pins to interrupts, lines 0–15 (RM0090 12.3). Lines 16–22 (PVD, RTC, USB, ETH) are not modelled.

use crate::soc::{
    access::Access,
    irq::Irq,
    peripheral::{Ctx, Peripheral, Unmodelled},
    pins::PinMode,
    registers::registers,
    syscfg::Syscfg,
};

registers! {
    IMR = 0x00,
    EMR = 0x04,
    RTSR = 0x08,
    FTSR = 0x0C,
    SWIER = 0x10,
    PR = 0x14,
}

const PIN_LINES: u32 = 0xFFFF;

#[derive(Debug, Default)]
pub struct Exti {
    imr: u32,
    rtsr: u32,
    ftsr: u32,
    pr: u32,
    /// Levels of the 16 lines at the last check.
    levels: u32,
}

impl Exti {
    /// Checks the pins. Edges that RTSR and FTSR select become pending.
    pub fn pins_changed(&mut self, syscfg: &Syscfg, ctx: &mut Ctx<'_>) {
        let levels = line_levels(syscfg, ctx);
        let rose = levels & !self.levels;
        let fell = self.levels & !levels;
        self.levels = levels;
        self.pr |= rose & self.rtsr | fell & self.ftsr;
        self.drive_irqs(ctx);
    }

    /// Connects a line to another port, whose level is taken over without an edge.
    pub fn sources_changed(&mut self, syscfg: &Syscfg, ctx: &mut Ctx<'_>) {
        self.levels = line_levels(syscfg, ctx);
    }

    /// Reports a board error for each unmasked line on which no edge can ever occur.
    pub fn check_sources(&self, syscfg: &Syscfg, ctx: &mut Ctx<'_>) {
        let unmasked = self.imr & (self.rtsr | self.ftsr);
        for line in (0..16).filter(|line| unmasked >> line & 1 == 1) {
            let pin = syscfg.exti_source(line);
            if ctx.pins.mode(pin) != PinMode::Output && !ctx.board.drives(pin) {
                let message =
                    format!("EXTI{line}: nothing modelled drives {pin}: no edge ever comes");
                ctx.errors.report(ctx.now, message);
            }
        }
    }

    fn drive_irqs(&self, ctx: &mut Ctx<'_>) {
        let active = self.pr & self.imr;
        for (irq, lines) in IRQS {
            ctx.irq.set(irq, active & lines != 0);
        }
    }

    fn value(&self, register: u32) -> Result<u32, Unmodelled> {
        Ok(match register {
            reg::IMR => self.imr,
            reg::EMR => 0,
            reg::RTSR => self.rtsr,
            reg::FTSR => self.ftsr,
            reg::SWIER => 0,
            reg::PR => self.pr,
            _ => return Err(reg::MAP.unmodelled_read("EXTI", register)),
        })
    }
}

/// NVIC position and lines of each EXTI vector (RM0090 table 62).
const IRQS: [(Irq, u32); 7] = [
    (6, 1 << 0),
    (7, 1 << 1),
    (8, 1 << 2),
    (9, 1 << 3),
    (10, 1 << 4),
    (23, 0x03E0),
    (40, 0xFC00),
];

fn line_levels(syscfg: &Syscfg, ctx: &Ctx<'_>) -> u32 {
    (0..16)
        .filter(|line| ctx.pins.level(syscfg.exti_source(*line)) == Some(true))
        .fold(0, |bits, line| bits | 1 << line)
}

impl Peripheral for Exti {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        Ok(access.read_of(self.value(access.register)?))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let is_pr = access.register == reg::PR;
        let old = if is_pr {
            0
        } else {
            self.value(access.register)?
        };
        let whole = access.written_over(old, value);
        if whole & !PIN_LINES != 0 && !is_pr {
            let what = format!("write of {whole:#010x} (line above 15)");
            return Err(reg::MAP.unmodelled("EXTI", access.register, what));
        }
        match access.register {
            reg::IMR => self.imr = whole,
            reg::RTSR => self.rtsr = whole,
            reg::FTSR => self.ftsr = whole,
            // SWIER sets the pending bit of an unmasked line.
            reg::SWIER => self.pr |= whole & self.imr,
            reg::PR => self.pr &= !whole,
            // EMR: no event is routed to the core.
            _ if whole == 0 => {}
            other => return Err(reg::MAP.unmodelled_write("EXTI", other, whole)),
        }
        self.drive_irqs(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self {
            levels: self.levels,
            ..Self::default()
        };
        self.drive_irqs(ctx);
    }
}
