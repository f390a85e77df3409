//! The diagnostics under a stable symbol, for live views in a debugger.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

use robot_app::diagnostics::DiagnosticsSnapshot;

/// The report of the control tick, which a debugger may read at any time.
#[repr(transparent)]
pub struct DebuggerView(UnsafeCell<DiagnosticsSnapshot>);

// SAFETY: the only access on the chip is through the one reference that `take` hands out.
unsafe impl Sync for DebuggerView {}

/// `g_robotapp_diag`, by which debuggers know it (docs/port.md#diagnostics).
#[used]
// SAFETY: no other symbol of the image has this name.
#[unsafe(no_mangle)]
pub static g_robotapp_diag: DebuggerView = DebuggerView(UnsafeCell::new(
    // SAFETY: numbers, bools and enums with a variant 0; the compiler checks the value of a static.
    unsafe { MaybeUninit::zeroed().assume_init() },
));

/// The one reference, with everything at its default. `None` after the first call.
pub fn take() -> Option<&'static mut DiagnosticsSnapshot> {
    static TAKEN: AtomicBool = AtomicBool::new(false);
    if TAKEN.swap(true, Ordering::Relaxed) {
        return None;
    }
    // SAFETY: the swap above lets one call through, so this reference is unique.
    let diagnostics = unsafe { &mut *g_robotapp_diag.0.get() };
    *diagnostics = DiagnosticsSnapshot::default();
    Some(diagnostics)
}
