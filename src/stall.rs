//! Erasing flash stops the whole chip for a quarter to half a second. Here everything learns of it that would otherwise
//! blame somebody: the clock, the deadlines, and whoever asks a [`StallWatch`].

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_time::{Duration, Ticker};

use crate::deadlines;
use crate::drivers::clock_repair;

/// Since boot. Written by `stand_still` while no task can run.
static STALLS: AtomicU32 = AtomicU32::new(0);
static LAST_STALL_US: AtomicU32 = AtomicU32::new(0);

/// Runs `work`, during which the chip stands still. Only for thread mode. `None`, and nothing done, if the clock would
/// be wrong afterwards.
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

/// Notices stalls from its making on.
pub struct StallWatch {
    seen: u32,
}

impl StallWatch {
    pub fn new() -> Self {
        Self {
            seen: STALLS.load(Ordering::Relaxed),
        }
    }

    /// How long the chip stood still last, if it did since the last call.
    pub fn news(&mut self) -> Option<u32> {
        let stalls = STALLS.load(Ordering::Relaxed);
        if stalls == self.seen {
            return None;
        }
        self.seen = stalls;
        Some(LAST_STALL_US.load(Ordering::Relaxed))
    }
}

/// A ticker that does not catch up on what a stall swallowed.
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
        if self.stalls.news().is_some() {
            self.restart();
        }
    }

    #[cold]
    #[inline(never)]
    fn restart(&mut self) {
        self.ticker.reset();
    }
}
