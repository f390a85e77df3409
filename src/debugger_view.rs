//! The diagnostics of the last tick under a stable symbol, for LiveWatch in a debugger.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;

use robot_app::diagnostics::DiagnosticsSnapshot;

/// Written by the control tick, read by nobody on the chip.
pub struct DebuggerView(UnsafeCell<DiagnosticsSnapshot>);

// SAFETY: the only access on the chip is the write in `DebuggerView::show`, whose contract allows one context.
unsafe impl Sync for DebuggerView {}

/// `g_robotapp_diag` as in ROBOT_CPP (seed section 0.7).
#[used]
#[unsafe(no_mangle)]
pub static g_robotapp_diag: DebuggerView = DebuggerView(UnsafeCell::new(
    // SAFETY: numbers, bools and enums with a variant 0; the compiler checks the value of a static.
    unsafe { MaybeUninit::zeroed().assume_init() },
));

impl DebuggerView {
    /// # Safety
    /// Only one context may call this.
    pub unsafe fn show(&self, diagnostics: &DiagnosticsSnapshot) {
        // SAFETY: the pointer is that of a static, and nobody else accesses it (contract). Volatile, because only
        // the debugger reads it.
        unsafe { self.0.get().write_volatile(*diagnostics) };
    }
}
