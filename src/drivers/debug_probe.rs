//! What a debug probe leaves in the core, and its undoing.
//!
//! A debugger can have the core halt by itself: at a fault, at the reset vector, at a breakpoint. Nobody sends zero
//! frames then, and after a reset not even the watchdog runs. probe-rs sets such catches unless told not to, and on this
//! chip takes nothing back when it ends; nor does a pulled cable, and no reset but power-on clears them (ARMv7-M ARM
//! C1.6). Software may: all but the enable bit itself. A halted watchdog is undone too, so a breakpoint ends in a reset.

use cortex_m::peripheral::{DCB, DWT, FPB};
use embassy_stm32::pac::DBGMCU;
use robot_app::domain::DebugProbe;

/// The one bit of DEMCR that stays: the cycle counter needs it.
const DEMCR_TRCENA: u32 = 1 << 24;
/// FP_CTRL: a write counts with KEY only.
const FP_CTRL_KEY: u32 = 1 << 1;
const FP_CTRL_ENABLE: u32 = 1;

/// Cheap while no debugger is or was attached: nothing of it has any effect then.
pub fn undo() -> DebugProbe {
    if DCB::is_debugger_attached() {
        undo_all()
    } else {
        DebugProbe::default()
    }
}

#[cold]
#[inline(never)]
fn undo_all() -> DebugProbe {
    // SAFETY: the address of these registers on every Cortex-M4; all accesses are volatile.
    let dcb = unsafe { &*DCB::PTR };
    // SAFETY: as for DCB: the core's own registers, with volatile accesses.
    let fpb = unsafe { &*FPB::PTR };
    // SAFETY: as for DCB: the core's own registers, with volatile accesses.
    let dwt = unsafe { &*DWT::PTR };
    // SAFETY: turns off vector catches, on which nothing in the image relies. Whoever is interrupted between reading and
    // writing DEMCR (`clock_repair.rs`) may put a catch back, until the next call.
    unsafe { dcb.demcr.modify(|demcr| demcr & DEMCR_TRCENA) };
    // SAFETY: turns off breakpoints, on which nothing in the image relies.
    unsafe { fpb.ctrl.write(FP_CTRL_KEY) };
    for watchpoint in dwt.c.iter().take(DWT::num_comp().into()) {
        // SAFETY: turns off a watchpoint; the image sets none.
        unsafe { watchpoint.function.write(0) };
    }
    DBGMCU.apb1fzr().modify(|w| {
        w.set_iwdg(false);
        w.set_wwdg(false);
    });
    let caught = dcb.demcr.read() & !DEMCR_TRCENA != 0;
    let breaks = fpb.ctrl.read() & FP_CTRL_ENABLE != 0;
    DebugProbe {
        attached: true,
        catches: caught || breaks || DBGMCU.apb1fzr().read().iwdg(),
    }
}
