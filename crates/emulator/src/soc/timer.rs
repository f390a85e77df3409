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
        registers::registers,
        scheduler::Target,
        wave::Wave,
    },
    time::Ps,
};
use counter::{Counter, UIF};

registers! {
    CR1 = 0x00,
    CR2 = 0x04,
    SMCR = 0x08,
    DIER = 0x0C,
    SR = 0x10,
    EGR = 0x14,
    CCMR1 = 0x18,
    CCMR2 = 0x1C,
    CCER = 0x20,
    CNT = 0x24,
    PSC = 0x28,
    ARR = 0x2C,
    RCR = 0x30,
    CCR1 = 0x34,
    CCR2 = 0x38,
    CCR3 = 0x3C,
    CCR4 = 0x40,
    BDTR = 0x44,
    DCR = 0x48,
    DMAR = 0x4C,
    OR = 0x50,
}

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
    /// Time and number of the latest scheduler event; earlier ones are stale.
    scheduled: Option<Ps>,
    generation: u32,
}

impl Timer {
    /// Number of the timer: 2, 3, 4, 5 or 10.
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

    /// The wave on the pin of channel 0–3; `None` while its output is off.
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

    fn name(&self) -> String {
        format!("TIM{}", self.number)
    }

    fn irq(&self) -> Irq {
        match self.number {
            2 => 28,
            3 => 29,
            4 => 30,
            5 => 50,
            // This interrupt is shared with TIM1's update.
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

    /// Updates interrupt line and next event after a change.
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

    /// The next update event, if it will change the output of a channel.
    fn pending_preload(&self) -> u32 {
        let pending = (0..4).any(|channel| {
            let compare = self.counter.compare[channel];
            self.ccer >> (4 * channel) & 1 == 1 && compare.written != compare.active
        });
        if pending { UIF } else { 0 }
    }

    fn value(&self, register: u32) -> Result<u32, Unmodelled> {
        Ok(match register {
            reg::CR1 => self.cr1,
            reg::CR2 | reg::SMCR | reg::OR => 0,
            reg::DIER => self.dier,
            reg::SR => self.sr,
            reg::EGR => 0,
            reg::CCMR1 => self.ccmr[0],
            reg::CCMR2 => self.ccmr[1],
            reg::CCER => self.ccer,
            reg::CNT => self.counter.count(),
            reg::PSC => self.counter.prescaler.written,
            reg::ARR => self.counter.reload.written,
            reg::CCR1..=reg::CCR4 => self.counter.compare[compare_index(register)].written,
            _ => return Err(reg::MAP.unmodelled_read(self.name(), register)),
        })
    }

    fn store(&mut self, register: u32, value: u32) -> Result<(), Unmodelled> {
        match register {
            reg::CR1 if value & !CR1_KNOWN == 0 => self.write_cr1(value),
            reg::DIER if value & !FLAGS == 0 => self.dier = value,
            // Flags are cleared by writing 0.
            reg::SR => self.sr &= value,
            reg::EGR if value & !FLAGS == 0 => self.write_egr(value),
            reg::CCMR1 | reg::CCMR2 => return self.write_ccmr(register, value),
            reg::CCER => self.ccer = value & if self.channels() == 1 { 0x3 } else { 0x3333 },
            reg::CNT => self.counter.set_count(value & self.counter.max()),
            reg::PSC => self.counter.prescaler.written = value & 0xFFFF,
            reg::ARR => self.write_arr(value),
            reg::CCR1..=reg::CCR4 => self.write_ccr(compare_index(register), value),
            // CR2, SMCR, OR: only their reset value.
            reg::CR2 | reg::SMCR | reg::OR if value == 0 => {}
            _ => return Err(reg::MAP.unmodelled_write(self.name(), register, value)),
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
                return Err(reg::MAP.unmodelled(self.name(), register, "input capture"));
            }
            if !output::mode_is_modelled(half >> 4 & 7) {
                return Err(reg::MAP.unmodelled(
                    self.name(),
                    register,
                    "toggling or one-shot output mode",
                ));
            }
        }
        self.ccmr[usize::from(register == reg::CCMR2)] = value & 0xFFFF;
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
        let old = if access.register == reg::SR {
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

/// TIM2–5 are on APB1, TIM10 is on APB2.
fn clock_hz(number: u8, clocks: &ClockTree) -> u32 {
    if number == 10 {
        clocks.tim2_hz
    } else {
        clocks.tim1_hz
    }
}

fn compare_index(register: u32) -> usize {
    ((register - reg::CCR1) / 4) as usize
}
