//! A debug probe on the core (ARMv7-M ARM C1). It halts the core, and the settings that it leaves halt the core later.

use super::Cpu;
use crate::{core::system::debug_registers::Debug, time::Ps};

impl Cpu {
    /// The debug registers, which a probe may change while the core runs.
    pub fn debug(&mut self) -> &mut Debug {
        &mut self.state_mut().system.debug
    }

    /// A probe halts the core now and resumes it after `time`.
    pub fn halt_for(&mut self, time: Ps) {
        let until = self.now().saturating_add(time);
        let state = self.state_mut();
        state.system.debug.attach(0);
        state.standstill.halted_until(Some(until));
        self.watchdog_follows();
    }

    /// The core halts by itself. Nobody resumes it, so it stays halted until a reset.
    pub(super) fn enter_debug_state(&mut self, at: &str) {
        self.state_mut().standstill.halted_until(Some(Ps::MAX));
        self.with_soc(|soc, now| {
            let what = format!("a debugger is waited for at {at}: the core stands still");
            soc.errors.report(now, what);
        });
        self.watchdog_follows();
    }

    /// DBG_IWDG_STOP stops the watchdog while the core is halted.
    pub(super) fn watchdog_follows(&mut self) {
        let state = self.state();
        let frozen = state.standstill.is_halted() && state.system.debug.stops_watchdog();
        self.with_soc(|soc, now| soc.freeze_watchdog(frozen, now));
    }
}
