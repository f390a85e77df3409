//! Keys of direction, which are the dead-man too: the robot moves only while one of them is held.
//!
//! Some terminals report when a key is let go (kitty, foot, WezTerm, Ghostty, recent Konsole, and the console of Windows).
//! There, keys combine. All others only repeat a held key, and only the key pressed last. There a key counts as let go
//! when its repetitions end, so the robot stops a moment later.

use std::time::Duration;

use super::Wish;

/// From the press of a key to its first repetition, at most.
const FIRST_REPEAT: Duration = Duration::from_millis(700);
/// From one repetition to the next, at most.
const NEXT_REPEAT: Duration = Duration::from_millis(200);
/// Where key releases are reported, a held key still repeats. Without any event for this long the terminal has lost the
/// keyboard.
const QUIET: Duration = Duration::from_secs(1);

/// A key's direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Forward,
    Backward,
    Left,
    Right,
    ForwardLeft,
    ForwardRight,
    /// Longer legs.
    Higher,
    /// Shorter legs.
    Lower,
    /// The left side goes down.
    LeftDown,
    /// The right side goes down.
    RightDown,
    Jump,
}

impl Direction {
    fn add_to(self, wish: &mut Wish) {
        match self {
            Self::Forward => wish.forward += 1.0,
            Self::Backward => wish.forward -= 1.0,
            Self::Left => wish.turn += 1.0,
            Self::Right => wish.turn -= 1.0,
            Self::ForwardLeft => {
                wish.forward += 1.0;
                wish.turn += 1.0;
            }
            Self::ForwardRight => {
                wish.forward += 1.0;
                wish.turn -= 1.0;
            }
            Self::Higher => wish.raise += 1.0,
            Self::Lower => wish.raise -= 1.0,
            Self::LeftDown => wish.tilt -= 1.0,
            Self::RightDown => wish.tilt += 1.0,
            Self::Jump => wish.jump = true,
        }
    }
}

/// The keys that are held, by a clock of the caller.
#[derive(Clone, Debug)]
pub struct Keyboard {
    reports_release: bool,
    held: Vec<Direction>,
    last_event: Duration,
    has_repeated: bool,
}

impl Keyboard {
    /// `reports_release` says whether the terminal reports when a key is let go.
    pub fn new(reports_release: bool) -> Self {
        Self {
            reports_release,
            held: Vec::new(),
            last_event: Duration::ZERO,
            has_repeated: false,
        }
    }

    pub fn reports_release(&self) -> bool {
        self.reports_release
    }

    /// A key was pressed, or repeats.
    pub fn press(&mut self, direction: Direction, now: Duration) {
        let was_held = self.is_alive(now) && self.held.contains(&direction);
        if !self.reports_release || !self.is_alive(now) {
            self.held.clear();
        }
        if !self.held.contains(&direction) {
            self.held.push(direction);
        }
        self.has_repeated = was_held;
        self.last_event = now;
    }

    pub fn release(&mut self, direction: Direction, now: Duration) {
        self.held.retain(|held| *held != direction);
        self.last_event = now;
    }

    /// All keys are let go: the stop key, or the terminal has lost the keyboard.
    pub fn release_all(&mut self) {
        self.held.clear();
    }

    pub fn wish(&self, now: Duration) -> Wish {
        let mut wish = Wish::NONE;
        if self.held.is_empty() || !self.is_alive(now) {
            return wish;
        }
        wish.is_held = true;
        for direction in &self.held {
            direction.add_to(&mut wish);
        }
        for share in [&mut wish.forward, &mut wish.turn] {
            *share = share.clamp(-1.0, 1.0);
        }
        wish
    }

    /// True if the keys that were held at the last event are held still.
    fn is_alive(&self, now: Duration) -> bool {
        let limit = match (self.reports_release, self.has_repeated) {
            (true, _) => QUIET,
            (false, false) => FIRST_REPEAT,
            (false, true) => NEXT_REPEAT,
        };
        now.saturating_sub(self.last_event) <= limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn forward(keyboard: &Keyboard, at: u64) -> f64 {
        keyboard.wish(ms(at)).forward
    }

    #[test]
    fn without_release_events_a_key_lasts_as_long_as_it_repeats() {
        let mut keyboard = Keyboard::new(false);
        keyboard.press(Direction::Forward, ms(0));
        assert_eq!(forward(&keyboard, 600), 1.0);
        for n in 0..50 {
            keyboard.press(Direction::Forward, ms(600 + 33 * n));
        }
        assert_eq!(forward(&keyboard, 600 + 33 * 49 + 150), 1.0);
        assert!(!keyboard.wish(ms(600 + 33 * 49 + 250)).is_held);
    }

    #[test]
    fn a_tap_ends_by_itself_and_the_next_one_is_no_repetition() {
        let mut keyboard = Keyboard::new(false);
        keyboard.press(Direction::Forward, ms(0));
        assert!(!keyboard.wish(ms(800)).is_held);
        keyboard.press(Direction::Forward, ms(5_000));
        assert_eq!(forward(&keyboard, 5_600), 1.0);
    }

    #[test]
    fn without_release_events_the_key_pressed_last_counts() {
        let mut keyboard = Keyboard::new(false);
        keyboard.press(Direction::Forward, ms(0));
        keyboard.press(Direction::Left, ms(100));
        let wish = keyboard.wish(ms(150));
        assert_eq!((wish.forward, wish.turn), (0.0, 1.0));
    }

    #[test]
    fn with_release_events_keys_combine_and_end_at_once() {
        let mut keyboard = Keyboard::new(true);
        keyboard.press(Direction::Forward, ms(0));
        keyboard.press(Direction::Left, ms(100));
        let wish = keyboard.wish(ms(150));
        assert_eq!((wish.forward, wish.turn), (1.0, 1.0));
        keyboard.release(Direction::Forward, ms(200));
        assert_eq!(keyboard.wish(ms(201)).forward, 0.0);
        keyboard.release(Direction::Left, ms(210));
        assert!(!keyboard.wish(ms(211)).is_held);
    }

    #[test]
    fn keys_of_a_standing_robot_raise_tilt_and_jump() {
        for (key, expected) in [
            (Direction::Higher, (1.0, 0.0, false)),
            (Direction::Lower, (-1.0, 0.0, false)),
            (Direction::LeftDown, (0.0, -1.0, false)),
            (Direction::RightDown, (0.0, 1.0, false)),
            (Direction::Jump, (0.0, 0.0, true)),
        ] {
            let mut keyboard = Keyboard::new(true);
            keyboard.press(Direction::Forward, ms(0));
            keyboard.press(key, ms(10));
            let wish = keyboard.wish(ms(20));
            assert_eq!((wish.raise, wish.tilt, wish.jump), expected);
            assert_eq!((wish.is_held, wish.forward), (true, 1.0));
            keyboard.release(key, ms(30));
            let wish = keyboard.wish(ms(40));
            assert_eq!((wish.raise, wish.tilt, wish.jump), (0.0, 0.0, false));
        }
    }

    /// The window lost the focus, and with it the event of the release.
    #[test]
    fn with_release_events_a_silent_terminal_stops_the_robot() {
        let mut keyboard = Keyboard::new(true);
        keyboard.press(Direction::Forward, ms(0));
        assert!(keyboard.wish(ms(999)).is_held);
        assert!(!keyboard.wish(ms(1_001)).is_held);
        keyboard.press(Direction::Left, ms(3_000));
        assert_eq!(forward(&keyboard, 3_001), 0.0);
    }
}
