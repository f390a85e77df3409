//! The independent watchdog (RM0090 chapter 21), on its own 32 kHz oscillator.

use crate::{
    soc::{
        access::Access,
        clocks::cycles_to_ps,
        peripheral::{Ctx, Peripheral, Unmodelled},
        registers::registers,
        scheduler::Target,
    },
    time::Ps,
};

registers! {
    KR = 0x00,
    PR = 0x04,
    RLR = 0x08,
    SR = 0x0C,
}

/// Keys of KR: PR and RLR may be written; count from RLR again; start.
const KEY_UNLOCK: u32 = 0x5555;
const KEY_RELOAD: u32 = 0xAAAA;
const KEY_START: u32 = 0xCCCC;
const LSI_HZ: u32 = 32_000;
/// A write to PR or RLR takes up to five cycles of the divided clock to cross into the watchdog's clock domain: "up to
/// 5 LSI clock periods divided by the clock prescaler" (ST's stm32f4xx_hal_iwdg.c, which waits six of them). Of the
/// dividers before and after the write the model takes the larger.
const UPDATE_CYCLES: u64 = 5;
const RELOAD_AFTER_RESET: u32 = 0xFFF;

/// A register written on the bus side and taken over by the LSI side later.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    value: u32,
    /// When `value` takes effect (never while the LSI stands), and the value that counts until then.
    pending: Option<(Ps, u32)>,
}

impl Crossing {
    fn at(value: u32) -> Self {
        Self {
            value,
            pending: None,
        }
    }

    fn busy(&self, now: Ps) -> bool {
        self.pending.is_some_and(|(until, _)| now < until)
    }

    fn effective(&self, now: Ps) -> u32 {
        self.pending
            .filter(|(until, _)| now < *until)
            .map_or(self.value, |(_, old)| old)
    }

    fn write(&mut self, value: u32, now: Ps) {
        let old = self.effective(now);
        *self = Self {
            value,
            pending: Some((Ps::MAX, old)),
        };
    }

    /// The LSI runs: what waited for it begins to cross, in steps of `period`.
    fn clocked(&mut self, now: Ps, period: Ps) {
        if let Some((until @ Ps::MAX, _)) = &mut self.pending {
            *until = now + UPDATE_CYCLES * period;
        }
    }
}

/// IWDG: once started, only a system reset stops it.
#[derive(Debug)]
pub struct Iwdg {
    prescaler: Crossing,
    reload: Crossing,
    unlocked: bool,
    /// When the counter reaches zero; none before the start.
    expires_at: Option<Ps>,
    /// When the next look at the counter comes; it moves itself on when the counter was reloaded meanwhile.
    watched_at: Option<Ps>,
    /// When DBG_IWDG_STOP stopped the counter, while the core is halted.
    frozen_since: Option<Ps>,
    bitten: bool,
}

impl Default for Iwdg {
    fn default() -> Self {
        Self::new()
    }
}

impl Iwdg {
    pub fn new() -> Self {
        Self {
            prescaler: Crossing::at(0),
            reload: Crossing::at(RELOAD_AFTER_RESET),
            unlocked: false,
            expires_at: None,
            watched_at: None,
            frozen_since: None,
            bitten: false,
        }
    }

    /// The counter stands, or goes on from where it stood.
    pub fn freeze(&mut self, frozen: bool, ctx: &mut Ctx<'_>) {
        match (self.frozen_since, frozen) {
            (None, true) => self.frozen_since = Some(ctx.now),
            (Some(since), false) => {
                self.frozen_since = None;
                if let Some(at) = self.expires_at.map(|at| at + (ctx.now - since)) {
                    self.expires_at = Some(at);
                    self.watch(at, ctx);
                }
            }
            _ => {}
        }
    }

    /// True once after the counter ran out.
    pub fn take_reset_request(&mut self) -> bool {
        std::mem::take(&mut self.bitten)
    }

    /// The counter starts again at `from`; it passes zero after one period more (RM0090 table 107: RLR = 0 is one
    /// period).
    fn count_from(&mut self, from: u32, ctx: &mut Ctx<'_>) {
        self.expire_after(u64::from(from) + 1, ctx);
    }

    /// Expires after that many periods of the prescaler, whose divider may change meanwhile.
    fn expire_after(&mut self, periods: u64, ctx: &mut Ctx<'_>) {
        let now = period(self.prescaler.effective(ctx.now));
        let change = self.prescaler.pending.map(|(at, _)| at);
        let change = change.filter(|at| (ctx.now..Ps::MAX).contains(at));
        let before = change.map_or(periods, |at| ((at - ctx.now) / now).min(periods));
        let at = ctx.now + before * now + (periods - before) * period(self.prescaler.value);
        self.expires_at = Some(at);
        if self.watched_at.is_none_or(|watched| at < watched) {
            self.watch(at, ctx);
        }
    }

    fn watch(&mut self, at: Ps, ctx: &mut Ctx<'_>) {
        self.watched_at = Some(at);
        ctx.scheduler.at(at, Target::Iwdg, 0);
    }

    fn key(&mut self, key: u32, ctx: &mut Ctx<'_>) {
        self.unlocked = key == KEY_UNLOCK;
        match key {
            KEY_START if self.expires_at.is_none() => {
                self.count_from(RELOAD_AFTER_RESET, ctx);
            }
            KEY_RELOAD if self.expires_at.is_some() => {
                self.count_from(self.reload.effective(ctx.now), ctx);
            }
            _ => {}
        }
    }

    /// Registers cross on LSI cycles only; a running watchdog keeps the LSI on (RM0090 21.3).
    fn cross(&mut self, ctx: &Ctx<'_>) {
        if ctx.clocks.lsi_on || self.expires_at.is_some() {
            let slowest = self.prescaler.effective(ctx.now).max(self.prescaler.value);
            self.prescaler.clocked(ctx.now, period(slowest));
            self.reload.clocked(ctx.now, period(slowest));
        }
    }

    fn write_guarded(&mut self, name: &str, value: u32, ctx: &mut Ctx<'_>) {
        let register = if name == "PR" {
            &mut self.prescaler
        } else {
            &mut self.reload
        };
        let refused = if !self.unlocked {
            Some("without the key 0x5555")
        } else if register.busy(ctx.now) {
            Some("while its last update is still under way")
        } else {
            None
        };
        match refused {
            Some(why) => ctx
                .errors
                .report(ctx.now, format!("IWDG: {name} written {why}: ignored")),
            None => register.write(value, ctx.now),
        }
    }

    /// Periods of the prescaler until the counter runs out.
    fn periods_left(&self, now: Ps) -> Option<u64> {
        let left = self.expires_at?.saturating_sub(now);
        Some(left.div_ceil(period(self.prescaler.effective(now))))
    }
}

impl Peripheral for Iwdg {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        self.cross(ctx);
        let value = match access.register {
            reg::KR => 0,
            reg::PR => self.prescaler.value,
            reg::RLR => self.reload.value,
            reg::SR => {
                u32::from(self.prescaler.busy(ctx.now)) | u32::from(self.reload.busy(ctx.now)) << 1
            }
            other => return Err(reg::MAP.unmodelled_read("IWDG", other)),
        };
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
        let value = access.written_over(0, value);
        match access.register {
            reg::KR => self.key(value & 0xFFFF, ctx),
            reg::PR => {
                let left = self.periods_left(ctx.now);
                self.write_guarded("PR", value & 7, ctx);
                self.cross(ctx);
                // The remaining periods are counted with the new divider once it has arrived in the watchdog's clock domain.
                if let Some(periods) = left {
                    self.expire_after(periods, ctx);
                }
            }
            reg::RLR => self.write_guarded("RLR", value & 0xFFF, ctx),
            reg::SR => {}
            other => return Err(reg::MAP.unmodelled_write("IWDG", other, value)),
        }
        self.cross(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, ctx: &mut Ctx<'_>) {
        let Some(at) = self.expires_at.filter(|_| self.frozen_since.is_none()) else {
            return;
        };
        if at <= ctx.now {
            self.expires_at = None;
            self.watched_at = None;
            self.bitten = true;
        } else if self.watched_at.is_some_and(|watched| watched <= ctx.now) {
            self.watch(at, ctx);
        }
    }

    fn reset(&mut self, _ctx: &mut Ctx<'_>) {
        *self = Self::new();
    }
}

/// Duration of one count at this value of PR.
fn period(prescaler: u32) -> Ps {
    cycles_to_ps(4 << prescaler.min(6), LSI_HZ)
}

#[cfg(test)]
mod tests;
