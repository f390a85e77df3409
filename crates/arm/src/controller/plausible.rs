//! A check of positions that the checksum cannot make.
//!
//! One damaged byte is always seen. Two damaged bytes in one answer pass the sum of 8 bits once in 256 times. Where such a
//! position is farther from the one before than a servo can turn in the time between, it is read again.

use std::time::Duration;

/// No joint is turned faster, not by hand either: two and a half turns a second. An STS3215 at 12 V turns 3,100 steps/s.
const FASTEST_STEPS_S: f64 = 10_000.0;
/// Noise of the sensor, and the time between the two samples on the wire.
const ALWAYS_PLAUSIBLE: i32 = 24;

/// The last position that was taken.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plausible {
    last: Option<(Duration, i32)>,
}

impl Plausible {
    pub(super) fn is_plausible(&self, now: Duration, steps: i32) -> bool {
        let Some((then, last)) = self.last else {
            return false;
        };
        let seconds = now.saturating_sub(then).as_secs_f64();
        let reach = ALWAYS_PLAUSIBLE.saturating_add((seconds * FASTEST_STEPS_S) as i32);
        agree(last, steps, reach)
    }

    pub(super) fn take(&mut self, now: Duration, steps: i32) {
        self.last = Some((now, steps));
    }
}

/// True if two positions read one after the other are those of one joint.
pub(super) fn are_one(first: i32, second: i32) -> bool {
    agree(first, second, 4 * ALWAYS_PLAUSIBLE)
}

/// A joint without stops goes from 4095 to 0 in one step.
fn agree(first: i32, second: i32, reach: i32) -> bool {
    let apart = first.saturating_sub(second).saturating_abs();
    apart <= reach || apart.saturating_sub(4096).saturating_abs() <= reach
}
