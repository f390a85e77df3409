//! Time in which the core runs nothing: the flash works and serves no fetch, a debug probe halts it, or the board has
//! no power.

use super::{Cpu, Halt, Pause, State, hooks};
use crate::{
    core::{
        memory::{CCM, SRAM, power_on_noise},
        system::System,
    },
    time::Ps,
};

/// Why no instruction is fetched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Standstill {
    flash_works_until: Option<Ps>,
    /// Debug state; `Ps::MAX` until a reset, when nobody is there to let the core go on.
    halted_until: Option<Ps>,
    /// `Ps::MAX` for as long as nobody gives the power back.
    no_power_until: Option<Ps>,
}

impl Standstill {
    pub(super) fn is_over(self) -> bool {
        self == Self::default()
    }

    pub(super) fn flash_works_until(&mut self, until: Option<Ps>) {
        self.flash_works_until = until;
    }

    pub(super) fn is_halted(self) -> bool {
        self.halted_until.is_some()
    }

    pub(super) fn halted_until(&mut self, until: Option<Ps>) {
        self.halted_until = until;
    }

    fn end(self) -> Ps {
        let either = self.flash_works_until.max(self.halted_until);
        self.no_power_until.or(either).unwrap_or_default()
    }
}

impl Cpu {
    /// The board is without power until then; chip and memories lose what they hold when it comes back.
    pub fn power_off(&mut self, until: Ps) {
        self.state_mut().standstill.no_power_until = Some(until);
    }

    /// The core comes up with noise in RAM; the chip has been reset.
    pub fn power_up(&mut self) {
        for ram in [SRAM, CCM] {
            self.engine
                .mem_write(ram.base.into(), &power_on_noise(ram))
                .expect("RAM is mapped");
        }
        let state = self.state_mut();
        state.standstill.no_power_until = None;
        state.system = System::default();
        self.reset();
    }

    /// Whether the board has power.
    pub fn is_powered(&self) -> bool {
        self.state().standstill.no_power_until.is_none()
    }

    /// Lets chip and board go on without the core; `None` when it runs again.
    pub(super) fn stand_still(&mut self) -> Result<Option<Pause>, Halt> {
        loop {
            hooks::run_due(&mut self.engine);
            if let Some(pause) = self.ended_by_chip()? {
                return Ok(Some(pause));
            }
            self.let_go();
            let state = self.state_mut();
            if state.standstill.is_over() {
                return Ok(None);
            }
            let no_power = state.standstill.no_power_until;
            if no_power.is_some_and(|until| until <= state.clock.now()) {
                return Ok(Some(Pause::PowerReturns));
            }
            if state.clock.cycles >= state.limit_cycle {
                return Ok(Some(Pause::Limit));
            }
            state.skip_standstill();
        }
    }

    /// The probe lets the core go on when its time is over.
    fn let_go(&mut self) {
        let now = self.now();
        let standstill = &mut self.state_mut().standstill;
        if standstill.halted_until.is_some_and(|until| until <= now) {
            standstill.halted_until = None;
            self.watchdog_follows();
        }
    }
}

impl State {
    fn skip_standstill(&mut self) {
        let before = self.clock.now();
        let end = self.clock.cycle_at(self.standstill.end());
        let next = self.due_cycle.min(end).max(self.clock.cycles);
        if self.standstill.is_halted() {
            self.system.halted_for(next - self.clock.cycles);
        }
        self.clock.cycles = next;
        self.stats.stood_still(self.clock.now() - before);
    }
}
