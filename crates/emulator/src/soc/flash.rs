//! Flash interface (RM0090 3.9): wait states, caches, lock, and programming and erasing of sectors 1–3.
//!
//! The core runs from the one bank there is: it stands still while the flash works. The other sectors hold the image
//! and are never written.

mod data_cache;
mod history;
mod operations;
mod registers;
mod sectors;
mod times;
mod work;

#[cfg(test)]
mod tests;

use crate::{
    soc::{
        access::Access,
        irq::Irq,
        peripheral::{Ctx, Peripheral, Unmodelled},
        registers::registers,
        scheduler::Target,
    },
    time::{MS, Ps},
};
use data_cache::DataCache;
use history::History;
use registers::{acr, cr, sr};
use sectors::WRITABLE_SECTORS;
use times::Parallelism;
use work::{UnderWay, Work};

pub use history::{FlashStep, FlashStepKind};
pub use times::FlashTimes;
pub use work::{CutPhase, PlannedCut};

registers! {
    ACR = 0x00,
    KEYR = 0x04,
    OPTKEYR = 0x08,
    SR = 0x0C,
    CR = 0x10,
    OPTCR = 0x14,
}

/// One wait state each 30 MHz at 2.7–3.6 V (RM0090 table 10).
const HZ_PER_WAIT_STATE: u32 = 30_000_000;

/// Keys that unlock CR when written to KEYR in this order. Any other value locks it until the next reset.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

const FLASH_IRQ: Irq = 4;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Lock {
    #[default]
    Locked,
    FirstKeyGiven,
    Open,
    UntilReset,
}

/// The flash interface and its operation in progress.
#[derive(Debug, Default)]
pub struct Flash {
    acr: u32,
    lock: Lock,
    cr: u32,
    sr: u32,
    cache: DataCache,
    times: FlashTimes,
    under_way: Option<UnderWay>,
    history: History,
    planned_cut: Option<PlannedCut>,
    /// A planned cut has come: the board loses its power now.
    power_fails: bool,
    /// Number of the latest scheduler event; earlier ones are stale.
    generation: u32,
    /// Time by which the caches should be on: 100 ms after the clock first needed wait states.
    caches_due: Option<Ps>,
}

/// Tag of the event that checks the caches. No generation reaches this number.
const CACHE_LOOK: u32 = u32::MAX;
/// Time that a boot has to turn the caches on.
const CACHES_ON_WITHIN: Ps = 100 * MS;

impl Flash {
    /// All programming and erase operations since power-on.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Sets the durations of programming and erasing from now on.
    pub fn set_times(&mut self, times: FlashTimes) {
        self.times = times;
    }

    /// Plans a loss of power at a step of the flash.
    pub fn plan_cut(&mut self, cut: PlannedCut) {
        self.planned_cut = Some(cut);
    }

    /// True once when a planned cut has come.
    pub fn take_power_failure(&mut self) -> bool {
        std::mem::take(&mut self.power_fails)
    }

    /// Time at which fetches are served again; `None` if the flash is not busy.
    pub fn stalled_until(&self) -> Option<Ps> {
        self.under_way.as_ref().map(|under_way| under_way.time.end)
    }

    fn update_interrupt(&self, ctx: &mut Ctx<'_>) {
        let ended = self.cr & cr::EOPIE != 0 && self.sr & sr::EOP != 0;
        let failed = self.cr & cr::ERRIE != 0 && self.sr & sr::ERRORS != 0;
        ctx.irq.set(FLASH_IRQ, ended || failed);
    }

    fn write_key(&mut self, key: u32, ctx: &mut Ctx<'_>) {
        self.lock = match (self.lock, key) {
            (Lock::Locked, key) if key == KEYS[0] => Lock::FirstKeyGiven,
            (Lock::FirstKeyGiven, key) if key == KEYS[1] => Lock::Open,
            (Lock::Open, _) => Lock::Open,
            _ => {
                let message = format!("FLASH: wrong key {key:#010x}: CR stays locked until reset");
                ctx.errors.report(ctx.now, message);
                Lock::UntilReset
            }
        };
    }

    fn write_control(&mut self, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if self.lock != Lock::Open {
            ctx.errors
                .report(ctx.now, "FLASH: CR written while locked: ignored");
            return Ok(());
        }
        self.cr = value & cr::KEPT;
        self.update_interrupt(ctx);
        if value & cr::LOCK != 0 {
            self.lock = Lock::Locked;
        }
        if value & cr::STRT != 0 && value & (cr::SER | cr::MER) != 0 {
            self.begin_erase(value, ctx)?;
        }
        Ok(())
    }

    fn begin_erase(&mut self, control: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        let sector = cr::sector(control);
        if control & cr::MER != 0 || !WRITABLE_SECTORS.contains(&sector) {
            let what = format!("erase of what the image runs from ({control:#010x})");
            return Err(reg::MAP.unmodelled("FLASH", reg::CR, what));
        }
        let address = Work::Erase { sector }.address();
        if control & cr::PG != 0 {
            self.refuse(sr::PGSERR, address, "an erase while PG is 1", ctx);
            return Ok(());
        }
        match Parallelism::of(control) {
            Some(by) => self.begin(Work::Erase { sector }, self.times.erase(by), ctx),
            None => {
                let what = "an erase with PSIZE = 64 bits, without a programming voltage";
                self.refuse(sr::PGPERR, address, what, ctx);
            }
        }
        Ok(())
    }

    fn write_access_control(&mut self, value: u32, ctx: &mut Ctx<'_>) {
        let value = value & acr::KNOWN;
        let enabled = self.acr | value;
        for (reset, enable, name) in [
            (acr::ICRST, acr::ICEN, "instruction"),
            (acr::DCRST, acr::DCEN, "data"),
        ] {
            if value & reset != 0 && enabled & enable != 0 {
                let message = format!("FLASH: {name} cache reset while it is on: ignored");
                ctx.errors.report(ctx.now, message);
            }
        }
        if value & acr::DCRST != 0 && enabled & acr::DCEN == 0 {
            self.cache.reset();
        }
        self.acr = value;
        self.cache.switch(value & acr::DCEN != 0);
        self.check_speed(ctx);
    }

    /// Reports a board error if `hclk_hz` needs more wait states than are set.
    pub(crate) fn check_speed(&mut self, ctx: &mut Ctx<'_>) {
        let needed = ctx
            .clocks
            .hclk_hz
            .div_ceil(HZ_PER_WAIT_STATE)
            .saturating_sub(1);
        if needed > 0 && self.caches_due.is_none() {
            let at = ctx.now + CACHES_ON_WITHIN;
            self.caches_due = Some(at);
            ctx.scheduler.at(at, Target::Flash, CACHE_LOOK);
        }
        let set = self.acr & acr::LATENCY;
        if set < needed {
            let hclk_hz = ctx.clocks.hclk_hz;
            ctx.errors.report(
                ctx.now,
                format!("FLASH: {set} wait states at HCLK {hclk_hz} Hz, needs {needed}: fetches return garbage"),
            );
        }
    }

    /// Reports caches that are off. Simulated time follows the count of instructions, so it does not show the cost of the
    /// wait states.
    fn check_caches(&self, ctx: &mut Ctx<'_>) {
        for (bit, name) in [
            (acr::PRFTEN, "prefetch"),
            (acr::ICEN, "instruction cache"),
            (acr::DCEN, "data cache"),
        ] {
            if self.acr & bit == 0 {
                let states = self.acr & acr::LATENCY;
                let message = format!(
                    "FLASH: {name} off at {states} wait states: code takes longer than this run shows"
                );
                ctx.errors.suspect(ctx.now, message);
            }
        }
    }

    fn status(&self) -> u32 {
        self.sr | if self.under_way.is_some() { sr::BSY } else { 0 }
    }

    fn control(&self) -> u32 {
        self.cr
            | if self.lock == Lock::Open { 0 } else { cr::LOCK }
            | match self.under_way.as_ref().and_then(|w| w.work) {
                Some(Work::Erase { .. }) => cr::STRT,
                _ => 0,
            }
    }
}

impl Peripheral for Flash {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        match access.register {
            reg::ACR => Ok(access.read_of(self.acr)),
            reg::SR => Ok(access.read_of(self.status())),
            reg::CR => Ok(access.read_of(self.control())),
            _ => Err(reg::MAP.unmodelled_read("FLASH", offset)),
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
        match access.register {
            reg::ACR => self.write_access_control(access.written_over(self.acr, value), ctx),
            reg::KEYR => self.write_key(value, ctx),
            reg::SR => {
                self.sr &= !(access.written_over(0, value) & sr::CLEARABLE);
                self.update_interrupt(ctx);
            }
            reg::CR => return self.write_control(access.written_over(self.cr, value), ctx),
            _ => return Err(reg::MAP.unmodelled_write("FLASH", offset, value)),
        }
        Ok(())
    }

    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>) {
        if tag == CACHE_LOOK && self.caches_due == Some(ctx.now) {
            self.check_caches(ctx);
        }
        if tag != self.generation {
            return;
        }
        let cut = self.under_way.as_ref().and_then(|w| w.cut);
        if cut.is_none_or(|cut| cut.phase == CutPhase::After) {
            self.end_work(ctx);
        }
        if let Some(cut) = cut {
            ctx.board.flash_cells().reseed(cut.seed);
            self.power_fails = true;
        }
    }

    /// Keeps the contents; an operation in progress is torn.
    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        if let Some(work) = self.under_way.take().and_then(|w| w.work) {
            work.tear(ctx.board.flash_cells());
        }
        self.acr = 0;
        self.lock = Lock::default();
        self.cr = 0;
        self.sr = 0;
        self.cache = DataCache::default();
        self.power_fails = false;
        self.generation += 1;
        self.caches_due = None;
        ctx.irq.set(FLASH_IRQ, false);
    }
}
