//! Which axes and which button of a joystick count.

use std::str::FromStr;

/// An axis by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisMap {
    pub number: u8,
    pub is_reversed: bool,
}

impl AxisMap {
    pub(super) fn share(self, value: f64) -> f64 {
        if self.is_reversed { -value } else { value }
    }
}

/// The default fits gamepads of the kinds of Xbox and PlayStation: left stick drives, right stick turns, and the left
/// shoulder button is the dead-man. The cross sets height and roll, and the lowest button jumps. Kernel drivers count up and
/// left as negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JoystickMap {
    pub forward: AxisMap,
    /// Left is positive.
    pub turn: AxisMap,
    /// Number of the button.
    pub dead_man: u8,
    /// Raises; long legs are positive.
    pub height: AxisMap,
    /// Tilts; the right side down is positive.
    pub roll: AxisMap,
    /// Number of the button.
    pub jump: u8,
}

impl Default for JoystickMap {
    fn default() -> Self {
        let reversed = |number| AxisMap {
            number,
            is_reversed: true,
        };
        Self {
            forward: reversed(1),
            turn: reversed(3),
            dead_man: 4,
            height: reversed(7),
            roll: AxisMap {
                number: 6,
                is_reversed: false,
            },
            jump: 0,
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JoystickMapError {
    #[error(
        "`{part}` is not understood: name axes and button by number, `-` reverses an axis, as in \
         forward=1-,turn=3-,dead-man=4,height=7-,roll=6,jump=0"
    )]
    Part { part: String },
    #[error(
        "button {button} is both the dead-man (4 if not named) and the jump (0 if not named): give each its own, as in \
         dead-man=0,jump=1"
    )]
    SameButton { button: u8 },
}

impl FromStr for JoystickMap {
    type Err = JoystickMapError;

    /// Parses parts such as `forward=1-`, separated by commas. What is not named stays as it is by default.
    fn from_str(text: &str) -> Result<Self, JoystickMapError> {
        let mut map = Self::default();
        for part in text.split(',') {
            let wrong = || JoystickMapError::Part {
                part: part.to_owned(),
            };
            let (name, value) = part.split_once('=').ok_or_else(wrong)?;
            match name.trim() {
                "forward" => map.forward = axis(value).ok_or_else(wrong)?,
                "turn" => map.turn = axis(value).ok_or_else(wrong)?,
                "dead-man" => map.dead_man = button(value).ok_or_else(wrong)?,
                "height" => map.height = axis(value).ok_or_else(wrong)?,
                "roll" => map.roll = axis(value).ok_or_else(wrong)?,
                "jump" => map.jump = button(value).ok_or_else(wrong)?,
                _ => return Err(wrong()),
            }
        }
        if map.jump == map.dead_man {
            return Err(JoystickMapError::SameButton { button: map.jump });
        }
        Ok(map)
    }
}

fn button(text: &str) -> Option<u8> {
    text.trim().parse().ok()
}

fn axis(text: &str) -> Option<AxisMap> {
    let text = text.trim();
    let (number, is_reversed) = match text.strip_suffix('-') {
        Some(number) => (number, true),
        None => (text, false),
    };
    let number = number.parse().ok()?;
    Some(AxisMap {
        number,
        is_reversed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_named_replaces_the_default() {
        let map: JoystickMap = "turn=0,dead-man=7".parse().unwrap();
        let turn = AxisMap {
            number: 0,
            is_reversed: false,
        };
        assert_eq!((map.turn, map.dead_man), (turn, 7));
        let map: JoystickMap = "height=2,roll=5-,jump=3".parse().unwrap();
        let numbers = (map.height.number, map.roll.number, map.jump);
        assert_eq!(numbers, (2, 5, 3));
        assert_eq!(
            (map.height.is_reversed, map.roll.is_reversed),
            (false, true)
        );
        assert_eq!(map.forward, JoystickMap::default().forward);
        assert_eq!(
            "forward=1-".parse::<JoystickMap>().unwrap(),
            JoystickMap::default()
        );
    }

    /// The button would never jump.
    #[test]
    fn one_button_for_dead_man_and_jump_is_refused() {
        for (text, button) in [("dead-man=0", 0), ("jump=4", 4), ("jump=2,dead-man=2", 2)] {
            let refused = text.parse::<JoystickMap>();
            assert_eq!(refused, Err(JoystickMapError::SameButton { button }));
        }
        let map: JoystickMap = "dead-man=0,jump=1".parse().unwrap();
        assert_eq!((map.dead_man, map.jump), (0, 1));
    }

    #[test]
    fn anything_else_is_refused() {
        for text in ["", "forward", "up=1", "turn=x", "dead-man=-1"] {
            assert!(text.parse::<JoystickMap>().is_err(), "{text}");
        }
    }
}
