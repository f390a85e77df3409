//! The engine's IT state after an access to the chip.
//!
//! For an access from within an IT block the engine sets its IT state to that of the instruction, and leaves it so when
//! the block of code goes on. Code that is looked up with it would be run as if it were conditional.

use unicorn_engine::{RegisterARM, Unicorn};

use super::State;

/// Bits 26, 25 and 15 to 10 of the XPSR (ARMv7-M ARM B1.4.2).
const IT_STATE: u64 = 0x0600_FC00;

/// At the start of a block of code, if the one before it has reached out to the chip.
pub(super) fn mend(engine: &mut Unicorn<'_, State>) {
    let Ok(xpsr) = engine.reg_read(RegisterARM::XPSR) else {
        return;
    };
    if xpsr & IT_STATE == 0 {
        return;
    }
    let block = engine.get_data().block;
    let length = block.end.wrapping_sub(block.start) as usize;
    let code = engine.mem_read_as_vec(block.start.into(), length);
    if code.is_ok_and(|code| !ends_within_it_block(&code)) {
        // It can be written at any time; a failure would show as wrong code as before.
        let _ = engine.reg_write(RegisterARM::XPSR, xpsr & !IT_STATE);
    }
}

pub(super) fn is_inside(engine: &Unicorn<'_, State>) -> bool {
    let xpsr = engine.reg_read(RegisterARM::XPSR);
    xpsr.is_ok_and(|xpsr| xpsr & IT_STATE != 0)
}

/// The instruction after these is still a conditional one.
fn ends_within_it_block(code: &[u8]) -> bool {
    let mut halves = code.as_chunks().0.iter().copied().map(u16::from_le_bytes);
    let mut conditional = 0;
    while let Some(half) = halves.next() {
        if half & 0xFF00 == 0xBF00 && half & 0x000F != 0 {
            // The lowest 1 of the mask ends it.
            conditional = 4 - (half & 0x000F).trailing_zeros();
            continue;
        }
        conditional = conditional.saturating_sub(1);
        if half >= 0xE800 {
            halves.next();
        }
    }
    conditional > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends_within(code: &[u16]) -> bool {
        let bytes: Vec<u8> = code.iter().flat_map(|half| half.to_le_bytes()).collect();
        ends_within_it_block(&bytes)
    }

    #[test]
    fn an_it_block_ends_after_as_many_instructions_as_it_says() {
        // cmp; ittt lo; ldrlo; strlo.w; cmplo
        let whole = [0x4563, 0xBF3E, 0x688D, 0xF843, 0x5B04, 0x4563];
        assert!(!ends_within(&whole));
        for end in [2, 3, 5] {
            assert!(ends_within(&whole[..end]), "{end}");
        }
        assert!(!ends_within(&whole[..1]));
        // it eq; moveq
        assert!(!ends_within(&[0xBF08, 0x2501]));
        // nop; wfe
        assert!(!ends_within(&[0xBF00, 0xBF20]));
    }
}
