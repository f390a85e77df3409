//! Where to go: the sticks of the radio, a joystick, the keyboard, or a file.

mod file;
mod wishes;

use std::{io, path::Path, time::Duration};

use robot_app::link::Sticks;
use robotctl::drive::{Joystick, JoystickError, JoystickMap, Keys, Wish};

pub use file::{CommandFile, CommandFileError};
pub use wishes::Wishes;

use crate::observation::Commands;

/// A stick of the radio counts beyond this share.
const DEAD_ZONE: f32 = 0.05;

/// A source that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// The joystick cannot be opened, or is gone.
    #[error(transparent)]
    Joystick(#[from] JoystickError),
    /// The terminal gives no keys.
    #[error("the terminal gives no single keys: run this in one, or choose another source")]
    Keys(#[source] io::Error),
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] CommandFileError),
}

/// Speeds that a stick at its end asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Forward in m/s.
    pub forward_mps: f32,
    /// Turn to the left in rad/s.
    pub yaw_rps: f32,
}

/// Says where to go.
pub enum CommandSource {
    /// Right stick of the radio, as the robot hears it: up is forward, left turns left.
    Radio(Speeds),
    /// A joystick of Linux. Its dead-man has to be held.
    Joystick(Joystick, Speeds),
    /// Keys of the terminal, which are the dead-man too.
    Keyboard(Keys, Speeds),
    /// Lines of a file, by the time since the policy took over.
    File(CommandFile),
}

/// What a source says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Said {
    /// Where to go.
    Commands(Commands),
    /// To end the run.
    End,
}

impl CommandSource {
    /// Opens a joystick such as `/dev/input/js0`, or a pipe with the same events.
    ///
    /// # Errors
    /// It cannot be opened.
    pub fn joystick(device: &Path, map: JoystickMap, speeds: Speeds) -> Result<Self, SourceError> {
        Ok(Self::Joystick(Joystick::open(device, map)?, speeds))
    }

    /// Takes the keys of the terminal.
    ///
    /// # Errors
    /// There is no terminal.
    pub fn keyboard(speeds: Speeds) -> Result<Self, SourceError> {
        let keys = Keys::take(false).map_err(SourceError::Keys)?;
        Ok(Self::Keyboard(keys, speeds))
    }

    /// Returns what it says now. `clock` only has to go on, and `policy_s` is the time in s since the policy took over, 0
    /// before.
    ///
    /// # Errors
    /// The joystick or the terminal is gone.
    pub fn read(
        &mut self,
        clock: Duration,
        policy_s: f64,
        sticks: &Sticks,
    ) -> Result<Said, SourceError> {
        let commands = match self {
            Self::Radio(speeds) => radio(sticks, speeds),
            Self::Joystick(joystick, speeds) => wished(joystick.wish(|_| {})?, speeds),
            Self::Keyboard(keys, speeds) => {
                if keys.poll(clock).map_err(SourceError::Keys)? {
                    return Ok(Said::End);
                }
                wished(keys.keyboard().wish(clock), speeds)
            }
            Self::File(file) => file.at(policy_s),
        };
        Ok(Said::Commands(commands))
    }
}

fn radio(sticks: &Sticks, speeds: &Speeds) -> Commands {
    let outside = |stick: f32| if stick.abs() > DEAD_ZONE { stick } else { 0.0 };
    Commands {
        forward_mps: outside(sticks.ry) * speeds.forward_mps,
        left_mps: 0.0,
        yaw_rps: -outside(sticks.rx) * speeds.yaw_rps,
    }
}

fn wished(wish: Wish, speeds: &Speeds) -> Commands {
    if !wish.is_held {
        return Commands::default();
    }
    Commands {
        forward_mps: wish.forward as f32 * speeds.forward_mps,
        left_mps: 0.0,
        yaw_rps: wish.turn as f32 * speeds.yaw_rps,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEEDS: Speeds = Speeds {
        forward_mps: 0.5,
        yaw_rps: 2.0,
    };

    #[test]
    fn a_stick_to_the_left_turns_left() {
        let sticks = Sticks {
            rx: -0.5,
            ry: 1.0,
            ..Sticks::default()
        };
        let commands = radio(&sticks, &SPEEDS);
        assert_eq!((commands.forward_mps, commands.yaw_rps), (0.5, 1.0));
        let near_centre = Sticks {
            rx: 0.04,
            ry: -0.04,
            ..Sticks::default()
        };
        let commands = radio(&near_centre, &SPEEDS);
        assert_eq!((commands.forward_mps, commands.yaw_rps), (0.0, 0.0));
    }

    #[test]
    fn hands_off_is_a_stop() {
        let mut wish = Wish {
            forward: 1.0,
            turn: -0.5,
            ..Wish::NONE
        };
        assert_eq!(wished(wish, &SPEEDS), Commands::default());
        wish.is_held = true;
        let commands = wished(wish, &SPEEDS);
        assert_eq!((commands.forward_mps, commands.yaw_rps), (0.5, -1.0));
    }
}
