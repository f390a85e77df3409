//! The user's wish to end a run.

use std::{mem, time::Duration};

/// A key that is held begins to repeat itself within this time, mostly 0.7 s.
const BEGINS: Duration = Duration::from_millis(800);
/// Then it repeats itself this often or more often.
const REPEATS: Duration = Duration::from_millis(150);

/// Tells a second wish from a key that is held. Only the first press may be held that long: who presses again and again is heard.
#[derive(Clone, Debug, Default)]
pub struct Wishes {
    last: Option<Duration>,
    /// The second has come: a key that is held repeats itself by now.
    has_second: bool,
}

impl Wishes {
    /// Takes a wish at this time. Returns whether it is another than the last.
    pub fn is_new(&mut self, now: Duration) -> bool {
        let Some(last) = self.last.replace(now) else {
            return true;
        };
        let has_second = mem::replace(&mut self.has_second, true);
        now.saturating_sub(last) > if has_second { REPEATS } else { BEGINS }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn new<const N: usize>(times_ms: [u64; N]) -> [bool; N] {
        let mut wishes = Wishes::default();
        times_ms.map(|ms| wishes.is_new(Duration::from_millis(ms)))
    }

    #[test]
    fn a_key_that_is_held_is_one_wish() {
        assert_eq!(
            new([0, 660, 693, 726, 850, 2300]),
            [true, false, false, false, false, true]
        );
    }

    #[test]
    fn who_presses_twice_a_second_is_heard() {
        assert_eq!(new([0, 500, 1000, 1500]), [true, false, true, true]);
    }

    #[test]
    fn a_second_press_is_heard() {
        assert_eq!(new([0, 900, 1300]), [true, true, true]);
    }
}
