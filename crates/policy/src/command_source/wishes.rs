//! The user's wish to end a run.

use std::time::Duration;

/// A key that is held repeats itself before this time is over; the first time takes longest, up to 0.7 s.
const REPEATS: Duration = Duration::from_millis(800);

/// Tells a second wish from a key that is held.
#[derive(Clone, Debug, Default)]
pub struct Wishes {
    last: Option<Duration>,
}

impl Wishes {
    /// Takes a wish at this time. Returns whether it is another than the last.
    pub fn is_new(&mut self, now: Duration) -> bool {
        let last = self.last.replace(now);
        last.is_none_or(|last| now.saturating_sub(last) > REPEATS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_that_is_held_is_one_wish() {
        let mut wishes = Wishes::default();
        let new: Vec<_> = [0, 660, 693, 726, 1400, 2300]
            .map(|ms| wishes.is_new(Duration::from_millis(ms)))
            .into();
        assert_eq!(new, [true, false, false, false, false, true]);
    }
}
