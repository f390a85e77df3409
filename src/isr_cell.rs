//! A value that belongs to one interrupt handler.

use core::cell::UnsafeCell;

/// Holds what one interrupt handler needs. Empty until [`install`](Self::install) is called at boot.
pub struct IsrCell<T>(UnsafeCell<Option<T>>);

// SAFETY: after `install`, which runs before the interrupt is unmasked, only that one interrupt handler
// touches the value (the contract of `with`), and a handler never preempts itself.
unsafe impl<T: Send> Sync for IsrCell<T> {}

impl<T> IsrCell<T> {
    pub const fn empty() -> Self {
        Self(UnsafeCell::new(None))
    }

    /// # Safety
    /// The interrupt whose handler calls [`with`](Self::with) must still be masked.
    pub unsafe fn install(&self, value: T) {
        // SAFETY: the handler cannot run yet (contract), so nobody else holds a reference.
        unsafe { *self.0.get() = Some(value) };
    }

    /// Runs `work` on the value, if it was installed.
    ///
    /// # Safety
    /// Only one interrupt handler may call this, and not recursively.
    pub unsafe fn with(&self, work: impl FnOnce(&mut T)) {
        // SAFETY: the calling handler is the only user (contract), so this reference is unique.
        if let Some(value) = unsafe { &mut *self.0.get() } {
            work(value);
        }
    }
}
