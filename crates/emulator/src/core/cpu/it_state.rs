//! The engine's IT state in an access to the chip, and in one to a page that the engine does not have at hand.
//!
//! For such an access from within an IT block the engine sets its IT state to that of the instruction, and does not restore
//! it afterwards. Code that is looked up in this state is translated as if it were conditional. The wrong translation is then
//! found by its address alone, from any block that jumps there.

use unicorn_engine::{RegisterARM, Unicorn};

use super::State;

/// Bits 26, 25 and 15 to 10 of the XPSR (ARMv7-M ARM B1.4.2).
const IT_STATE: u64 = 0x0600_FC00;

/// Clears the state in the access itself, before any code can be looked up. The rest of the block contains its own
/// conditions, and a block that ends within an IT block sets the state again at its end.
pub(super) fn clear(engine: &mut Unicorn<'_, State>) {
    if let Ok(xpsr) = engine.reg_read(RegisterARM::XPSR)
        && xpsr & IT_STATE != 0
    {
        // The register can be written at any time. A failure would show as skipped code.
        let _ = engine.reg_write(RegisterARM::XPSR, xpsr & !IT_STATE);
    }
}

pub(super) fn is_inside(engine: &Unicorn<'_, State>) -> bool {
    let xpsr = engine.reg_read(RegisterARM::XPSR);
    xpsr.is_ok_and(|xpsr| xpsr & IT_STATE != 0)
}
