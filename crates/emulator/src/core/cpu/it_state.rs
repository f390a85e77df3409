//! The engine's IT state in an access to the chip.
//!
//! For an access from within an IT block the engine sets its IT state to that of the instruction, and leaves it so when
//! the block of code goes on. Code that is looked up with it is translated as if it were conditional, and found again by
//! its address alone wherever the block before it jumps.

use unicorn_engine::{RegisterARM, Unicorn};

use super::State;

/// Bits 26, 25 and 15 to 10 of the XPSR (ARMv7-M ARM B1.4.2).
const IT_STATE: u64 = 0x0600_FC00;

/// In the access itself, before any code can be looked up. The rest of the block has its conditions in it, and a block
/// that ends within an IT block sets the state anew at its end.
pub(super) fn mend(engine: &mut Unicorn<'_, State>) {
    if let Ok(xpsr) = engine.reg_read(RegisterARM::XPSR)
        && xpsr & IT_STATE != 0
    {
        // It can be written at any time; a failure would show as code that is skipped.
        let _ = engine.reg_write(RegisterARM::XPSR, xpsr & !IT_STATE);
    }
}

pub(super) fn is_inside(engine: &Unicorn<'_, State>) -> bool {
    let xpsr = engine.reg_read(RegisterARM::XPSR);
    xpsr.is_ok_and(|xpsr| xpsr & IT_STATE != 0)
}
