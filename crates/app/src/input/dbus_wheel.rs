//! The thumb wheel of a DBUS transmitter takes the place of a stand switch and a jump button. It returns to its centre
//! when released.
//!
//! Transmitters without a wheel send arbitrary values in its place. So the wheel must be held for some frames.

use crate::domain::StandSwitch;

/// The wheel counts as turned beyond this position, and as released below half of it.
const TURNED: f32 = 0.7;
/// Frames for which the wheel must be held, 0.14 s.
const HELD_FRAMES: u8 = 10;

/// Held down, the wheel asks for sitting; then, held up, for standing. Turned up once more, it asks for a jump.
#[derive(Clone, Debug, Default)]
pub(super) struct DbusWheel {
    up_frames: u8,
    down_frames: u8,
    stand: StandSwitch,
    /// The wheel has been released since the request to stand.
    released: bool,
}

impl DbusWheel {
    /// Takes the wheel's position in a frame, −1…1, up positive.
    pub fn step(&mut self, position: f32) {
        count(&mut self.up_frames, position > TURNED);
        count(&mut self.down_frames, position < -TURNED);
        if self.down_frames >= HELD_FRAMES {
            self.stand = StandSwitch::Down;
        } else if self.up_frames >= HELD_FRAMES && self.stand == StandSwitch::Down {
            self.stand = StandSwitch::Up;
            self.released = false;
        } else if position.abs() < TURNED / 2.0 {
            self.released = true;
        }
    }

    /// The position that a stand switch would have.
    pub const fn stand(&self) -> StandSwitch {
        self.stand
    }

    /// Whether a jump button would be pressed.
    pub fn jump(&self) -> bool {
        self.stand == StandSwitch::Up && self.released && self.up_frames > 0
    }
}

fn count(frames: &mut u8, turned: bool) {
    *frames = if turned { frames.saturating_add(1) } else { 0 };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hold(wheel: &mut DbusWheel, position: f32, frames: u8) -> (StandSwitch, bool) {
        (0..frames).for_each(|_| wheel.step(position));
        (wheel.stand(), wheel.jump())
    }

    #[test]
    fn the_wheel_sits_down_then_stands_then_jumps() {
        let mut wheel = DbusWheel::default();
        assert_eq!(hold(&mut wheel, 1.0, 50), (StandSwitch::Unknown, false));
        assert_eq!(hold(&mut wheel, -1.0, 9), (StandSwitch::Unknown, false));
        assert_eq!(hold(&mut wheel, -1.0, 1), (StandSwitch::Down, false));
        assert_eq!(hold(&mut wheel, 0.0, 5), (StandSwitch::Down, false));
        assert_eq!(hold(&mut wheel, 1.0, 9), (StandSwitch::Down, false));
        assert_eq!(hold(&mut wheel, 1.0, 50), (StandSwitch::Up, false));
        assert_eq!(hold(&mut wheel, 0.0, 1), (StandSwitch::Up, false));
        assert_eq!(hold(&mut wheel, 1.0, 1), (StandSwitch::Up, true));
        assert_eq!(hold(&mut wheel, 0.5, 1), (StandSwitch::Up, false));
        assert_eq!(hold(&mut wheel, -1.0, 10), (StandSwitch::Down, false));
    }

    /// Neither a constant nor a value that jumps from end to end asks for anything.
    #[test]
    fn a_transmitter_without_a_wheel_asks_for_nothing() {
        for constant in [-1.0, 0.0, 1.0] {
            let mut wheel = DbusWheel::default();
            let (stand, jump) = hold(&mut wheel, constant, 200);
            assert!(stand != StandSwitch::Up && !jump);
        }
        let mut wheel = DbusWheel::default();
        for _ in 0..100 {
            hold(&mut wheel, -1.0, 5);
            let jumping = hold(&mut wheel, 1.0, 5);
            assert_eq!(jumping, (StandSwitch::Unknown, false));
        }
    }
}
