//! Code made to go wrong at the entry of a function: how a run shows that the image survives its own failure.
//!
//! Nothing is patched: the program is caught where the function begins, before its first instruction.

use unicorn_engine::{RegisterARM, Unicorn};

use super::{Cpu, Halt, State, Stop};
use crate::core::{faults::Fault, memory::HANG};

/// What the function does instead of its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Once: goes to another function, with the arguments it got.
    GoTo(u32),
    /// Once: its first instruction is undefined.
    Undefined,
    /// Once: finds the stack pointer here.
    StackAt(u32),
    /// Once: does not come back, until the effect ends.
    Hang,
    /// Every time: comes back at once.
    ReturnAtOnce,
}

/// A function, and what goes wrong when it is entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Injection {
    /// Address of the function, without the Thumb bit.
    pub entry: u32,
    /// What it does instead.
    pub effect: Effect,
}

/// Effect that waits for its function, and functions that hang.
#[derive(Debug, Default)]
pub(super) struct Injector {
    waiting: Vec<Injection>,
    hanging: Option<Injection>,
    /// A function that hung and may go on.
    released: Option<u32>,
}

impl Injector {
    pub(super) fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.released.is_none()
    }
}

/// True if the block at `start` must not run as it stands.
pub(super) fn strikes(engine: &mut Unicorn<'_, State>, start: u32) -> bool {
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
    /// The effect waits from now on for its function to be called.
    pub fn inject(&mut self, injection: Injection) {
        let waiting = &mut self.state_mut().injector.waiting;
        if !waiting.contains(&injection) {
            waiting.push(injection);
        }
    }

    /// Effect that has not struck will not; a function that hangs does its work now.
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
