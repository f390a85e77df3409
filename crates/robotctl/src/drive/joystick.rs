//! Joysticks of Linux: events of eight bytes from `/dev/input/js0`.

mod map;
mod reader;

pub use map::{AxisMap, JoystickMap, JoystickMapError};
pub use reader::{Joystick, JoystickError};

use super::Wish;

/// Size of an event.
const EVENT_BYTES: usize = 8;
const BUTTON: u8 = 0x01;
const AXIS: u8 = 0x02;
/// Marks the events that tell the state at the start.
const INITIAL: u8 = 0x80;
const FULL_SCALE: f64 = 32_767.0;
/// A stick that is let go stands this near to its centre.
const DEAD_ZONE: f64 = 0.08;

/// One event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JoystickEvent {
    Button {
        number: u8,
        is_down: bool,
    },
    /// The value is −1…1.
    Axis {
        number: u8,
        value: f64,
    },
}

impl JoystickEvent {
    /// Decodes time (u32), value (i16), kind and number, in the computer's own byte order. Returns `None` for other
    /// kinds of events.
    pub fn decode([_, _, _, _, low, high, kind, number]: [u8; EVENT_BYTES]) -> Option<Self> {
        let value = i16::from_ne_bytes([low, high]);
        match kind & !INITIAL {
            BUTTON => Some(Self::Button {
                number,
                is_down: value != 0,
            }),
            AXIS => Some(Self::Axis {
                number,
                value: (f64::from(value) / FULL_SCALE).clamp(-1.0, 1.0),
            }),
            _ => None,
        }
    }
}

/// The state of the axes and buttons that count.
#[derive(Clone, Debug)]
pub struct JoystickState {
    map: JoystickMap,
    forward: f64,
    turn: f64,
    raise: f64,
    tilt: f64,
    jump: bool,
    is_held: bool,
}

impl JoystickState {
    pub fn new(map: JoystickMap) -> Self {
        Self {
            map,
            forward: 0.0,
            turn: 0.0,
            raise: 0.0,
            tilt: 0.0,
            jump: false,
            is_held: false,
        }
    }

    pub fn take(&mut self, event: JoystickEvent) {
        let map = self.map;
        match event {
            JoystickEvent::Button { number, is_down } if number == map.dead_man => {
                self.is_held = is_down;
            }
            JoystickEvent::Button { number, is_down } if number == map.jump => {
                self.jump = is_down;
            }
            JoystickEvent::Axis { number, value } => {
                if number == map.forward.number {
                    self.forward = map.forward.share(value);
                }
                if number == map.turn.number {
                    self.turn = map.turn.share(value);
                }
                if number == map.height.number {
                    self.raise = map.height.share(value);
                }
                if number == map.roll.number {
                    self.tilt = map.roll.share(value);
                }
            }
            JoystickEvent::Button { .. } => {}
        }
    }

    pub fn wish(&self) -> Wish {
        Wish {
            is_held: self.is_held,
            forward: outside_dead_zone(self.forward),
            turn: outside_dead_zone(self.turn),
            raise: outside_dead_zone(self.raise),
            tilt: outside_dead_zone(self.tilt),
            jump: self.jump,
        }
    }
}

/// Returns 0 near the centre, and rises from there to the full value.
fn outside_dead_zone(value: f64) -> f64 {
    let beyond = (value.abs() - DEAD_ZONE).max(0.0) / (1.0 - DEAD_ZONE);
    beyond.copysign(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(value: i16, kind: u8, number: u8) -> JoystickEvent {
        let [low, high] = value.to_ne_bytes();
        JoystickEvent::decode([1, 2, 3, 4, low, high, kind, number]).unwrap()
    }

    #[test]
    fn events_of_the_kernel_are_decoded() {
        let pressed = JoystickEvent::Button {
            number: 4,
            is_down: true,
        };
        assert_eq!(event(1, 0x01, 4), pressed);
        assert_eq!(event(1, 0x81, 4), pressed);
        let up = JoystickEvent::Axis {
            number: 1,
            value: -1.0,
        };
        assert_eq!(event(-32_767, 0x02, 1), up);
        assert_eq!(event(-32_768, 0x82, 1), up);
        assert_eq!(JoystickEvent::decode([0; 8]), None);
    }

    #[test]
    fn a_stick_pushed_forward_with_the_button_held_is_a_wish() {
        let mut state = JoystickState::new(JoystickMap::default());
        state.take(event(-32_767, 0x02, 1));
        state.take(event(16_384, 0x02, 3));
        assert!(!state.wish().is_held);
        state.take(event(1, 0x01, 4));
        let wish = state.wish();
        assert!(wish.is_held);
        assert_eq!(wish.forward, 1.0);
        assert!((-0.47..-0.44).contains(&wish.turn), "{wish:?}");
        state.take(event(0, 0x01, 4));
        assert!(!state.wish().is_held);
    }

    #[test]
    fn the_cross_raises_and_tilts_and_a_button_jumps() {
        let mut state = JoystickState::new(JoystickMap::default());
        state.take(event(-32_767, 0x02, 7));
        state.take(event(32_767, 0x02, 6));
        state.take(event(1, 0x01, 0));
        let wish = state.wish();
        assert_eq!((wish.raise, wish.tilt, wish.jump), (1.0, 1.0, true));
        state.take(event(0, 0x01, 0));
        assert!(!state.wish().jump);
    }

    #[test]
    fn a_stick_near_its_centre_is_at_its_centre() {
        let mut state = JoystickState::new(JoystickMap::default());
        state.take(event(2_000, 0x02, 1));
        assert_eq!(state.wish().forward, 0.0);
    }
}
