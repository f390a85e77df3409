//! Memory that survives a reset, in which a failing run leaves its cause for the next one.

use core::cell::UnsafeCell;

use robot_app::domain::{CrashCause, ResetCause};

/// How the run before this one ended.
#[derive(Clone, Copy)]
pub struct LastRun {
    /// Why the chip was reset.
    pub reset_cause: ResetCause,
    /// What the run left in the crash record.
    pub crash_cause: CrashCause,
}

/// The control tick and the fault handlers write it; boot reads and clears it.
struct Slot(UnsafeCell<[u32; 2]>);

// SAFETY: `write` and `take` say in their contracts that no two accesses overlap.
unsafe impl Sync for Slot {}

/// The start-up code does not initialise `.uninit`, which holds noise after power-on.
// SAFETY: `memory.x` and cortex-m-rt place the section in SRAM, where any static may live.
#[unsafe(link_section = ".uninit.crash_record")]
static SLOT: Slot = Slot(UnsafeCell::new([0; 2]));

/// Upper 24 bits of a valid word. Its complement follows it, so that noise is not taken for one.
const MARK: u32 = 0x4C57_A500;

/// Records why this run fails.
///
/// # Safety
/// Only the control tick, or a fault handler with all interrupts disabled, may call this.
pub unsafe fn write(cause: CrashCause) {
    let word = MARK | u32::from(cause.code());
    // SAFETY: a static; the contract forbids concurrent access. Volatile, because nothing in this run reads it.
    unsafe { SLOT.0.get().write_volatile([word, !word]) };
}

/// Reads the record of the run before and clears it.
///
/// # Safety
/// Only `main` may call this, before any task runs.
pub unsafe fn take() -> CrashCause {
    // SAFETY: a static; the contract forbids concurrent access. Volatile, because its initial value is not what the
    // memory holds.
    let [word, complement] = unsafe { SLOT.0.get().read_volatile() };
    // SAFETY: a static; the contract forbids concurrent access.
    unsafe { SLOT.0.get().write_volatile([0; 2]) };
    let [code, mark @ ..] = word.to_le_bytes();
    let [_, expected_mark @ ..] = MARK.to_le_bytes();
    if word == !complement && mark == expected_mark {
        CrashCause::from_code(code).unwrap_or_default()
    } else {
        CrashCause::Silent
    }
}
