//! Checks the registers of accesses that must be word-aligned.

use unicorn_engine::{RegisterARM, Unicorn};

use super::{State, context, it_state};
use crate::core::alignment::WordAccesses;

const REGISTERS: [RegisterARM; 13] = [
    RegisterARM::R0,
    RegisterARM::R1,
    RegisterARM::R2,
    RegisterARM::R3,
    RegisterARM::R4,
    RegisterARM::R5,
    RegisterARM::R6,
    RegisterARM::R7,
    RegisterARM::R8,
    RegisterARM::R9,
    RegisterARM::R10,
    RegisterARM::R11,
    RegisterARM::R12,
];

/// Returns false if the block that begins will access a word at an unaligned address.
pub(super) fn holds_before(engine: &Unicorn<'_, State>, accesses: WordAccesses) -> bool {
    let mut wanted = accesses.before;
    let mut wrong = accesses.wrong;
    while wanted != 0 && !wrong {
        let bit = wanted.trailing_zeros();
        wanted &= wanted - 1;
        wrong = !is_aligned(engine, bit / 4, bit % 4);
    }
    // Instructions of an IT block that began before may not be executed.
    !wrong || it_state::is_inside(engine)
}

/// Returns false if the block that has run accessed a word at an unaligned address.
pub(super) fn held_after(engine: &mut Unicorn<'_, State>) -> bool {
    let mut wanted = std::mem::take(&mut engine.get_data_mut().block.aligned_after);
    while wanted != 0 {
        let register = wanted.trailing_zeros();
        wanted &= wanted - 1;
        if !is_aligned(engine, register, 0) {
            return false;
        }
    }
    true
}

fn is_aligned(engine: &Unicorn<'_, State>, register: u32, plus: u32) -> bool {
    let name = REGISTERS.get(register as usize);
    name.is_none_or(|name| context::register(engine, *name).wrapping_add(plus) & 3 == 0)
}
