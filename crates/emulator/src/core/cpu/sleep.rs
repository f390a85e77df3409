//! WFE and WFI: idle time passes in steps from event to event.

use super::{Cpu, Halt, Pause, State, Stop, context, hooks};
use crate::core::{exception::Exception, nvic::Masks};

/// Kind of sleep: WFE waits for an event, WFI for an interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SleepKind {
    Event,
    Interrupt,
}

impl Cpu {
    pub(super) fn wait_for_event(&mut self) -> Option<Pause> {
        if std::mem::take(&mut self.state_mut().event) {
            return None;
        }
        self.fall_asleep(SleepKind::Event)
    }

    /// Called when the engine returned by itself. It does so only for a WFI, with the PC behind that instruction.
    pub(super) fn wait_for_interrupt(&mut self) -> Result<Option<Pause>, Halt> {
        const WFI: u16 = 0xBF30;
        const WFI_W: u16 = 0x8003;
        let mut before = [0; 2];
        let read = self.read_memory(self.pc().wrapping_sub(2), &mut before);
        match u16::from_le_bytes(before) {
            WFI | WFI_W if read => Ok(self.fall_asleep(SleepKind::Interrupt)),
            _ => Err(self.halt("the engine stopped for no reason".to_owned())),
        }
    }

    /// SCR.SLEEPONEXIT: no handler is left, and the code they interrupted does not go on (ARMv7-M ARM B1.5.8).
    pub(super) fn sleep_on_exit(&mut self) {
        if self.state().system.sleeps_on_exit() {
            self.asleep = Some(SleepKind::Interrupt);
        }
    }

    fn fall_asleep(&mut self, kind: SleepKind) -> Option<Pause> {
        self.asleep = Some(kind);
        Some(Pause::Asleep {
            thread: self.state().system.nvic.current() == Exception::THREAD,
        })
    }

    /// Passes idle time in one step from event to event; `None` when the core wakes.
    pub(super) fn sleep(&mut self, kind: SleepKind) -> Result<Option<Pause>, Halt> {
        let masks = context::masks(&self.engine);
        loop {
            hooks::run_due(&mut self.engine);
            if let Some(pause) = self.ended_by_chip()? {
                return Ok(Some(pause));
            }
            let state = self.state_mut();
            if state.wakes(kind, masks) {
                return Ok(None);
            }
            if state.system.sleeps_deeply() {
                let what = "SCB SCR: SLEEPDEEP is set and the core sleeps: the chip stops all its clocks (RM0090 \
                            5.3.4, Stop mode), which is not modelled";
                return Err(self.halt(what.to_owned()));
            }
            if state.clock.cycles >= state.limit_cycle {
                return Ok(Some(Pause::Limit));
            }
            state.skip_idle();
        }
    }

    /// Returns the pause that chip or board caused while no code ran, if any.
    pub(super) fn ended_by_chip(&mut self) -> Result<Option<Pause>, Halt> {
        match self.state_mut().stop.take() {
            Some(Stop::Reset(cause)) => Ok(Some(Pause::Reset(cause))),
            Some(Stop::Unmodelled(access)) => Err(self.halt_in_block(access.to_string())),
            _ => Ok(None),
        }
    }
}

impl State {
    fn skip_idle(&mut self) {
        let cycles = self.due_cycle.saturating_sub(self.clock.cycles);
        self.clock.cycles += cycles;
        self.stats.idle_cycles += cycles;
    }

    fn wakes(&mut self, kind: SleepKind, masks: Masks) -> bool {
        match kind {
            SleepKind::Event => {
                std::mem::take(&mut self.event) || self.system.deliverable(masks).is_some()
            }
            SleepKind::Interrupt => self.system.nvic.wakes_from_wfi(masks),
        }
    }
}
