//! Undoes what a debug probe leaves in the core.
//!
//! A debugger can set the core to halt at a fault, at the reset vector or at a breakpoint. A halted core sends no zero frames,
//! and after a reset not even the watchdog runs. probe-rs sets such catches by default and leaves them when it ends. A pulled
//! cable leaves them too, and only power-on clears them (ARMv7-M ARM C1.6). Software can clear all but the enable bit itself.
//! A watchdog that stops while the core is halted is undone as well, so that a breakpoint ends in a reset.

use cortex_m::peripheral::{DCB, DWT, FPB};
use embassy_stm32::pac::DBGMCU;
use robot_app::domain::DebugProbe;

/// The bit of DEMCR that stays set, because the cycle counter needs it.
const DEMCR_TRCENA: u32 = 1 << 24;
/// FP_CTRL accepts a write only with KEY set.
const FP_CTRL_KEY: u32 = 1 << 1;
const FP_CTRL_ENABLE: u32 = 1;

/// Undoes catches, breakpoints and watchpoints, and reports what was found. Cheap if no debugger was attached since
/// power-on.
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
