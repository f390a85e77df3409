//! Faults injected at the entry of a function, to show that the image survives its own failures.
//!
//! The image is not patched: the program is stopped at the function's first instruction.

use unicorn_engine::{RegisterARM, Unicorn};

use super::{Cpu, Halt, State, Stop};
use crate::core::{faults::Fault, memory::HANG};

/// Effect of an injected fault, in place of the function's work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Once, execution continues in another function with the same arguments.
    GoTo(u32),
    /// Once, the function's first instruction is undefined.
    Undefined,
    /// Once, the stack pointer gets this value.
    StackAt(u32),
    /// Once, the function does not return until the injection ends.
    Hang,
    /// Every call of the function returns at once.
    ReturnAtOnce,
}

/// A fault to inject when a function is entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Injection {
    /// Address of the function, without the Thumb bit.
    pub entry: u32,
    /// Effect in place of the function's work.
    pub effect: Effect,
}

/// An effect that waits for its function to be called, and functions that hang.
#[derive(Debug, Default)]
pub(super) struct Injector {
    waiting: Vec<Injection>,
    hanging: Option<Injection>,
    /// A function that hung and may now continue.
    released: Option<u32>,
}

impl Injector {
    pub(super) fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.released.is_none()
    }
}

/// Whether a fault is injected at the block at `start`. If so, the block must not run.
pub(super) fn is_due(engine: &mut Unicorn<'_, State>, start: u32) -> bool {
    let state = engine.get_data_mut();
    if state.injector.is_idle() {
        return false;
    }
    if start == HANG.base
        && let Some(entry) = state.injector.released.take()
    {
        state.stop = Some(Stop::Released(entry));
        return true;
    }
    let waiting = &mut state.injector.waiting;
    let Some(place) = waiting.iter().position(|s| s.entry == start) else {
        return false;
    };
    let injection = waiting[place];
    if injection.effect != Effect::ReturnAtOnce {
        waiting.remove(place);
        state.struck_at = Some(state.clock.now());
    }
    state.stop = Some(Stop::Injected(injection));
    true
}

impl Cpu {
    /// Injects the fault the next time its function is called.
    pub fn inject(&mut self, injection: Injection) {
        let waiting = &mut self.state_mut().injector.waiting;
        if !waiting.contains(&injection) {
            waiting.push(injection);
        }
    }

    /// Withdraws a fault that has not been injected yet. A function that hangs continues.
    pub fn end_injection(&mut self, injection: Injection) {
        let injector = &mut self.state_mut().injector;
        injector.waiting.retain(|s| *s != injection);
        if injector.hanging == Some(injection) {
            injector.hanging = None;
            injector.released = Some(injection.entry);
        }
    }

    pub(super) fn take_effect(&mut self, injection: Injection) -> Result<(), Halt> {
        match injection.effect {
            Effect::GoTo(target) => self.set_register(RegisterARM::PC, target | 1),
            Effect::Undefined => return self.raise(Fault::UndefinedInstruction),
            Effect::StackAt(address) => self.set_register(RegisterARM::SP, address),
            Effect::Hang => {
                self.state_mut().injector.hanging = Some(injection);
                self.set_register(RegisterARM::PC, HANG.base | 1);
            }
            Effect::ReturnAtOnce => {
                let back = self.register(RegisterARM::LR);
                self.set_register(RegisterARM::PC, back | 1);
            }
        }
        Ok(())
    }
}
