//! Stalls: erasing a flash sector stops the whole chip for a quarter to half a second.
//!
//! The clock and the task deadlines are corrected at once. All other code that measures time asks a [`StallWatch`].

pub mod clock_repair;

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_time::{Duration, Ticker};

use crate::deadlines;

/// Stalls since boot. `stand_still` writes it while no task can run.
static STALLS: AtomicU32 = AtomicU32::new(0);
static LAST_STALL_US: AtomicU32 = AtomicU32::new(0);

/// Runs `work`, during which the chip stands still. Thread mode only. Returns `None` without running it if the clock could
/// not be corrected afterwards.
pub fn stand_still<R>(work: impl FnOnce() -> R) -> Option<R> {
    clock_repair::keep_time(work, |stall_us| {
        deadlines::start();
        LAST_STALL_US.store(stall_us, Ordering::Relaxed);
        STALLS.store(
            STALLS.load(Ordering::Relaxed).wrapping_add(1),
            Ordering::Relaxed,
        );
    })
}

/// Notices stalls that happen after it was created.
pub struct StallWatch {
    seen: u32,
}

impl StallWatch {
    pub fn new() -> Self {
        Self {
            seen: STALLS.load(Ordering::Relaxed),
        }
    }

    /// Length of the last stall in µs, if there was one since the last call.
    pub fn take(&mut self) -> Option<u32> {
        let stalls = STALLS.load(Ordering::Relaxed);
        if stalls == self.seen {
            return None;
        }
        self.seen = stalls;
        Some(LAST_STALL_US.load(Ordering::Relaxed))
    }
}

/// A ticker that skips the ticks lost in a stall instead of catching up.
pub struct SteadyTicker {
    ticker: Ticker,
    stalls: StallWatch,
}

impl SteadyTicker {
    pub fn every(period: Duration) -> Self {
        Self {
            ticker: Ticker::every(period),
            stalls: StallWatch::new(),
        }
    }

    pub async fn next(&mut self) {
        self.ticker.next().await;
        if self.stalls.take().is_some() {
            self.restart();
        }
    }

    #[cold]
    #[inline(never)]
    fn restart(&mut self) {
        self.ticker.reset();
    }
}
