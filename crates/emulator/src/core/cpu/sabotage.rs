//! Code made to go wrong at the entry of a function: how a run shows that the image survives its own failure.
//!
//! Nothing is patched: the program is caught where the function begins, before its first instruction.

use unicorn_engine::{RegisterARM, Unicorn};

use super::{Cpu, Halt, State, Stop};
use crate::core::{faults::Fault, memory::HANG};

/// What the function does instead of its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harm {
    /// Once: goes to another function, with the arguments it got.
    GoTo(u32),
    /// Once: its first instruction is undefined.
    Undefined,
    /// Once: finds the stack pointer here.
    StackAt(u32),
    /// Once: does not come back, until the harm ends.
    Hang,
    /// Every time: comes back at once.
    ReturnAtOnce,
}

/// A function, and what goes wrong when it is entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sabotage {
    /// Address of the function, without the Thumb bit.
    pub entry: u32,
    /// What it does instead.
    pub harm: Harm,
}

/// Harm that waits for its function, and functions that hang.
#[derive(Debug, Default)]
pub(super) struct Saboteur {
    waiting: Vec<Sabotage>,
    hanging: Option<Sabotage>,
    /// A function that hung and may go on.
    released: Option<u32>,
}

impl Saboteur {
    pub(super) fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.released.is_none()
    }
}

/// True if the block at `start` must not run as it stands.
pub(super) fn strikes(engine: &mut Unicorn<'_, State>, start: u32) -> bool {
    let state = engine.get_data_mut();
    if state.saboteur.is_idle() {
        return false;
    }
    if start == HANG.base
        && let Some(entry) = state.saboteur.released.take()
    {
        state.stop = Some(Stop::Released(entry));
        return true;
    }
    let waiting = &mut state.saboteur.waiting;
    let Some(place) = waiting.iter().position(|s| s.entry == start) else {
        return false;
    };
    let sabotage = waiting[place];
    if sabotage.harm != Harm::ReturnAtOnce {
        waiting.remove(place);
        state.struck_at = Some(state.clock.now());
    }
    state.stop = Some(Stop::Sabotaged(sabotage));
    true
}

impl Cpu {
    /// The harm waits from now on for its function to be called.
    pub fn sabotage(&mut self, sabotage: Sabotage) {
        let waiting = &mut self.state_mut().saboteur.waiting;
        if !waiting.contains(&sabotage) {
            waiting.push(sabotage);
        }
    }

    /// Harm that has not struck will not; a function that hangs does its work now.
    pub fn end_sabotage(&mut self, sabotage: Sabotage) {
        let saboteur = &mut self.state_mut().saboteur;
        saboteur.waiting.retain(|s| *s != sabotage);
        if saboteur.hanging == Some(sabotage) {
            saboteur.hanging = None;
            saboteur.released = Some(sabotage.entry);
        }
    }

    pub(super) fn suffer(&mut self, sabotage: Sabotage) -> Result<(), Halt> {
        match sabotage.harm {
            Harm::GoTo(target) => self.set_register(RegisterARM::PC, target | 1),
            Harm::Undefined => return self.raise(Fault::UndefinedInstruction),
            Harm::StackAt(address) => self.set_register(RegisterARM::SP, address),
            Harm::Hang => {
                self.state_mut().saboteur.hanging = Some(sabotage);
                self.set_register(RegisterARM::PC, HANG.base | 1);
            }
            Harm::ReturnAtOnce => {
                let back = self.register(RegisterARM::LR);
                self.set_register(RegisterARM::PC, back | 1);
            }
        }
        Ok(())
    }
}
