//! Loads and stores of the core, and the effect of programming and erasing on cells and cache.

use super::{
    Flash, FlashStep, Lock,
    registers::{cr, sr},
    sectors,
    times::Parallelism,
    work::{CutPhase, UnderWay, Work},
};
use crate::{
    soc::{access::Access, peripheral::Ctx, scheduler::Target},
    time::Ps,
};

impl Flash {
    /// A load from sectors 1–3, of 1, 2 or 4 bytes.
    pub(crate) fn load(&mut self, address: u32, size: u8, ctx: &mut Ctx<'_>) -> u32 {
        if self.under_way.as_ref().is_some_and(|w| w.cut.is_none()) {
            // The bus holds the load until the word is in the cells.
            self.reach_the_cells(ctx);
        }
        let access = Access::new(address, size);
        let cached = self.cache.word(access.register);
        access.read_of(cached.unwrap_or_else(|| ctx.board.flash_cells().read_word(access.register)))
    }

    /// A store to sectors 1–3.
    pub(crate) fn store(&mut self, address: u32, size: u8, value: u32, ctx: &mut Ctx<'_>) {
        let Some(parallelism) = self.programs(address, ctx) else {
            return;
        };
        if size != parallelism.bytes() {
            let needed = parallelism.bytes();
            let what = format!("{size} bytes stored where PSIZE programs {needed} at once");
            return self.refuse(sr::PGPERR, address, &what, ctx);
        }
        let access = Access::new(address, size);
        let work = Work::Program {
            address: access.register,
            word: access.written_over(u32::MAX, value),
            stored: access.written_over(0, u32::MAX),
        };
        self.begin(work, self.times.program(), ctx);
    }

    /// Number of bits that a store programs, or `None` if it is refused.
    fn programs(&mut self, address: u32, ctx: &mut Ctx<'_>) -> Option<Parallelism> {
        if self.lock != Lock::Open || self.cr & cr::PG == 0 {
            self.refuse(sr::PGSERR, address, "a store while PG is 0", ctx);
            return None;
        }
        let parallelism = Parallelism::of(self.cr);
        if parallelism.is_none() {
            let what = "a store with PSIZE = 64 bits, without a programming voltage";
            self.refuse(sr::PGPERR, address, what, ctx);
        }
        parallelism
    }

    pub(super) fn refuse(&mut self, flag: u32, address: u32, what: &str, ctx: &mut Ctx<'_>) {
        ctx.errors.report(
            ctx.now,
            format!("FLASH: {what} at {address:#010x}: ignored"),
        );
        self.sr |= flag;
        self.update_interrupt(ctx);
    }

    pub(super) fn begin(&mut self, work: Work, duration: Ps, ctx: &mut Ctx<'_>) {
        // The bus holds a request until the operation before it is done. If the power fails first, it is never served.
        let start = match &self.under_way {
            Some(before) if before.cut.is_some() => return,
            Some(before) => before.time.end,
            None if self.power_fails => return,
            None => ctx.now,
        };
        self.reach_the_cells(ctx);
        let step = self.history.steps().len();
        let cut = self.planned_cut.take_if(|cut| cut.step == step);
        let time = start..start + duration;
        let begun = FlashStep {
            at: start,
            kind: work.kind(),
            address: work.address(),
        };
        self.history.begun(begun, &time);
        if cut.is_some_and(|cut| cut.phase == CutPhase::Before) {
            self.under_way = None;
            self.power_fails = true;
            return;
        }
        let under_way = UnderWay {
            time,
            work: Some(work),
            cut,
        };
        self.generation += 1;
        ctx.scheduler
            .at(under_way.next_event(), Target::Flash, self.generation);
        self.under_way = Some(under_way);
    }

    /// Applies the finished operation to the contents.
    fn reach_the_cells(&mut self, ctx: &mut Ctx<'_>) {
        let Some(work) = self.under_way.as_mut().and_then(|w| w.work.take()) else {
            return;
        };
        let cells = ctx.board.flash_cells();
        match work {
            Work::Program {
                address,
                word,
                stored,
            } => {
                let visible = self.cache.word(address);
                let before = visible.unwrap_or_else(|| cells.read_word(address));
                self.cache
                    .programmed(address, word & stored | before & !stored);
            }
            Work::Erase { sector } => {
                let words = sectors::addresses(sector).step_by(4);
                self.cache
                    .erased(words.map(|address| (address, cells.read_word(address))));
            }
        }
        work.perform(cells);
    }

    pub(super) fn end_work(&mut self, ctx: &mut Ctx<'_>) {
        self.reach_the_cells(ctx);
        self.under_way = None;
        // Without its interrupt the end is not shown (RM0090 3.9.4).
        if self.cr & cr::EOPIE != 0 {
            self.sr |= sr::EOP;
        }
        self.update_interrupt(ctx);
    }
}
