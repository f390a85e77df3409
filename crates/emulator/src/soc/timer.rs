//! General-purpose timers TIM2–5 and TIM10: edge-aligned up-counting, output compare, PWM (RM0090 sections 18, 19).
//!
//! Down and centre counting, capture, slave mode and timer DMA are not modelled.

pub mod counter;
pub mod output;

use crate::{
    soc::{
        access::Access,
        clocks::{ClockTree, cycles_to_ps, ps_to_cycles},
        irq::Irq,
        peripheral::{Ctx, Peripheral, Unmodelled},
        scheduler::Target,
        wave::Wave,
    },
    time::Ps,
};
use counter::{Counter, UIF};

const CEN: u32 = 1;
const UDIS: u32 = 1 << 1;
const URS: u32 = 1 << 2;
const OPM: u32 = 1 << 3;
const ARPE: u32 = 1 << 7;
const CR1_KNOWN: u32 = CEN | UDIS | URS | OPM | ARPE | 0x300;
const UG: u32 = 1;
const FLAGS: u32 = 0x1F;

#[derive(Debug)]
pub struct Timer {
    number: u8,
    counter: Counter,
    cr1: u32,
    dier: u32,
    sr: u32,
    ccmr: [u32; 2],
    ccer: u32,
    /// Cycle 0 of the counter and the clock since then.
    epoch: Ps,
    clock_hz: u32,
    /// Time and number of the scheduler event that still counts.
    scheduled: Option<Ps>,
    generation: u32,
}

impl Timer {
    /// 2, 3, 4, 5 or 10.
    pub fn new(number: u8) -> Self {
        let max = if matches!(number, 2 | 5) {
            u32::MAX
        } else {
            0xFFFF
        };
        Self {
            number,
            counter: Counter::new(max),
            cr1: 0,
            dier: 0,
            sr: 0,
            ccmr: [0; 2],
            ccer: 0,
            epoch: 0,
            clock_hz: clock_hz(number, &ClockTree::default()),
            scheduled: None,
            generation: 0,
        }
    }

    /// What channel 0–3 drives onto its pin; none while its output is off.
    pub fn wave(&self, channel: usize) -> Option<Wave> {
        let enable = self.ccer >> (4 * channel);
        (enable & 1 == 1).then(|| {
            output::wave(
                &self.counter,
                channel,
                self.ocm(channel),
                enable & 2 != 0,
                self.clock_hz,
            )
        })
    }

    fn ocm(&self, channel: usize) -> u32 {
        self.channel_mode(channel) >> 4 & 7
    }

    fn channel_mode(&self, channel: usize) -> u32 {
        self.ccmr[channel / 2] >> (8 * (channel % 2)) & 0xFF
    }

    fn channels(&self) -> usize {
        if self.number == 10 { 1 } else { 4 }
    }

    fn irq(&self) -> Irq {
        match self.number {
            2 => 28,
            3 => 29,
            4 => 30,
            5 => 50,
            // Shared with TIM1's update.
            _ => 25,
        }
    }

    fn catch_up(&mut self, now: Ps) {
        let cycle = ps_to_cycles(now - self.epoch, self.clock_hz);
        self.sr |= self.counter.advance(cycle);
        if !self.counter.enabled {
            self.cr1 &= !CEN;
        }
    }

    /// Interrupt line and next event after anything changed.
    fn settle(&mut self, ctx: &mut Ctx<'_>) {
        ctx.irq.set(self.irq(), self.sr & self.dier & FLAGS != 0);
        let awaited = self.dier & !self.sr & FLAGS | self.pending_preload();
        let Some(cycle) = self.counter.next_flag(awaited) else {
            return;
        };
        let at = self.epoch + cycles_to_ps(cycle, self.clock_hz);
        if self.scheduled.is_none_or(|earlier| at < earlier) {
            self.generation += 1;
            self.scheduled = Some(at);
            ctx.scheduler
                .at(at, Target::Timer(self.number), self.generation);
        }
    }

    /// The update event, if it will change what a channel drives onto its pin.
    fn pending_preload(&self) -> u32 {
        let pending = (0..4).any(|channel| {
            let compare = self.counter.compare[channel];
            self.ccer >> (4 * channel) & 1 == 1 && compare.written != compare.active
        });
        if pending { UIF } else { 0 }
    }

    fn value(&self, register: u32) -> Result<u32, Unmodelled> {
        Ok(match register {
            0x00 => self.cr1,
            0x04 | 0x08 | 0x50 => 0,
            0x0C => self.dier,
            0x10 => self.sr,
            0x14 => 0,
            0x18 => self.ccmr[0],
            0x1C => self.ccmr[1],
            0x20 => self.ccer,
            0x24 => self.counter.count(),
            0x28 => self.counter.prescaler.written,
            0x2C => self.counter.reload.written,
            0x34..=0x40 => self.counter.compare[compare_index(register)].written,
            _ => return Err(self.unmodelled(register, "read")),
        })
    }

    fn store(&mut self, register: u32, value: u32) -> Result<(), Unmodelled> {
        match register {
            0x00 if value & !CR1_KNOWN == 0 => self.write_cr1(value),
            0x0C if value & !FLAGS == 0 => self.dier = value,
            // Flags are cleared by writing 0.
            0x10 => self.sr &= value,
            0x14 if value & !FLAGS == 0 => self.write_egr(value),
            0x18 | 0x1C => return self.write_ccmr(register, value),
            0x20 => self.ccer = value & if self.channels() == 1 { 0x3 } else { 0x3333 },
            0x24 => self.counter.set_count(value & self.counter.max()),
            0x28 => self.counter.prescaler.written = value & 0xFFFF,
            0x2C => self.write_arr(value),
            0x34..=0x40 => self.write_ccr(compare_index(register), value),
            // CR2, SMCR, OR: only their reset value.
            0x04 | 0x08 | 0x50 if value == 0 => {}
            _ => return Err(self.unmodelled(register, &format!("write of {value:#010x}"))),
        }
        Ok(())
    }

    fn write_cr1(&mut self, value: u32) {
        self.cr1 = value;
        self.counter.enabled = value & CEN != 0;
        self.counter.update_disabled = value & UDIS != 0;
        self.counter.one_pulse = value & OPM != 0;
    }

    fn write_egr(&mut self, value: u32) {
        self.sr |= value & (FLAGS & !UIF);
        if value & UG != 0 && self.cr1 & UDIS == 0 {
            self.counter.update();
            if self.cr1 & URS == 0 {
                self.sr |= UIF;
            }
        }
    }

    fn write_ccmr(&mut self, register: u32, value: u32) -> Result<(), Unmodelled> {
        for half in [value & 0xFF, value >> 8 & 0xFF] {
            if half & 3 != 0 {
                return Err(self.unmodelled(register, "input capture"));
            }
            if !output::mode_is_modelled(half >> 4 & 7) {
                return Err(self.unmodelled(register, "toggling or one-shot output mode"));
            }
        }
        self.ccmr[usize::from(register == 0x1C)] = value & 0xFFFF;
        Ok(())
    }

    fn write_arr(&mut self, value: u32) {
        let value = value & self.counter.max();
        let reload = &mut self.counter.reload;
        reload.written = value;
        if self.cr1 & ARPE == 0 {
            reload.load();
        }
    }

    fn write_ccr(&mut self, channel: usize, value: u32) {
        let preload = self.channel_mode(channel) & 0x08 != 0;
        let value = value & self.counter.max();
        self.counter.compare[channel].written = value;
        if !preload {
            self.counter.compare[channel].load();
        }
    }

    fn unmodelled(&self, register: u32, what: &str) -> Unmodelled {
        const NAMES: [&str; 21] = [
            "CR1", "CR2", "SMCR", "DIER", "SR", "EGR", "CCMR1", "CCMR2", "CCER", "CNT", "PSC",
            "ARR", "RCR", "CCR1", "CCR2", "CCR3", "CCR4", "BDTR", "DCR", "DMAR", "OR",
        ];
        let number = self.number;
        let register = NAMES.get((register / 4) as usize).map_or_else(
            || format!("TIM{number}+{register:#x}"),
            |name| format!("TIM{number}.{name}"),
        );
        Unmodelled {
            register,
            what: what.to_owned(),
        }
    }
}

impl Peripheral for Timer {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        self.catch_up(ctx.now);
        let value = self.value(access.register)?;
        self.settle(ctx);
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
        self.catch_up(ctx.now);
        // Bits of SR outside a narrow access keep their flags.
        let old = if access.register == 0x10 {
            u32::MAX
        } else {
            self.value(access.register)?
        };
        self.store(access.register, access.written_over(old, value))?;
        self.settle(ctx);
        Ok(())
    }

    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>) {
        if tag != self.generation {
            return;
        }
        self.scheduled = None;
        self.catch_up(ctx.now);
        self.settle(ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self {
            epoch: ctx.now,
            clock_hz: clock_hz(self.number, ctx.clocks),
            generation: self.generation + 1,
            ..Self::new(self.number)
        };
        ctx.irq.set(self.irq(), false);
    }

    fn clocks_changed(&mut self, ctx: &mut Ctx<'_>) {
        self.catch_up(ctx.now);
        self.epoch = ctx.now;
        self.counter.restart_cycles();
        self.clock_hz = clock_hz(self.number, ctx.clocks);
        self.scheduled = None;
        self.settle(ctx);
    }
}

/// TIM2–5 hang on APB1, TIM10 on APB2.
fn clock_hz(number: u8, clocks: &ClockTree) -> u32 {
    if number == 10 {
        clocks.tim2_hz
    } else {
        clocks.tim1_hz
    }
}

fn compare_index(register: u32) -> usize {
    ((register - 0x34) / 4) as usize
}
