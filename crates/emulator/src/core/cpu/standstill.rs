//! Time in which the core runs nothing, because the flash is busy and serves no fetch, a debug probe halts the core or the
//! board has no power.

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
    /// Debug state until this time, or `Ps::MAX` if nobody will resume the core before a reset.
    halted_until: Option<Ps>,
    /// No power until this time, or `Ps::MAX` while its return is not planned.
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
    /// Takes the power away until the given time. Chip and memories lose their contents when it returns.
    pub fn power_off(&mut self, until: Ps) {
        self.state_mut().standstill.no_power_until = Some(until);
    }

    /// Starts the core after a power cut, with noise in RAM. The chip must have been reset.
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

    /// Advances chip and board without the core. Returns `None` when the core runs again.
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

    /// Resumes the core when the probe's halt is over.
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
