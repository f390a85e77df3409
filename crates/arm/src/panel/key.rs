//! Keys that both screens have.

use std::time::Duration;

/// What a key asks of the arm.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    Nothing,
    /// Send the goals that the screen has.
    Send,
    /// Stop where it is, with torque.
    Hold,
    /// Torque off: the arm falls.
    Release,
    /// Torque on, where it is.
    Engage,
    Home,
    End,
}

/// The stop key: once holds, twice within a second takes the torque away.
#[derive(Debug, Default)]
pub struct StopKey {
    pressed: Option<Duration>,
}

const TWICE_WITHIN: Duration = Duration::from_secs(1);

impl StopKey {
    pub fn press(&mut self, now: Duration) -> Action {
        let is_second = self
            .pressed
            .is_some_and(|then| now.saturating_sub(then) < TWICE_WITHIN);
        self.pressed = (!is_second).then_some(now);
        if is_second {
            Action::Release
        } else {
            Action::Hold
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stop_key_holds_once_and_releases_twice() {
        let mut stop = StopKey::default();
        let at = Duration::from_millis;
        assert_eq!(stop.press(at(0)), Action::Hold);
        assert_eq!(stop.press(at(900)), Action::Release);
        assert_eq!(stop.press(at(1000)), Action::Hold);
        assert_eq!(stop.press(at(3000)), Action::Hold);
    }
}
