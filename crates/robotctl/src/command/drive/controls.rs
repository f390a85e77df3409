//! Where the user's wishes come from: the keyboard, a joystick, or both.

use std::{
    io::{IsTerminal, stdin, stdout},
    path::Path,
    time::Duration,
};

use anyhow::{Context, Result, bail, ensure};
use robotctl::drive::{Joystick, JoystickEvent, JoystickMap, Keys, Wish};

pub struct Controls {
    /// `None` without a terminal.
    keys: Option<Keys>,
    joystick: Option<Joystick>,
    map: JoystickMap,
    last_event: Option<JoystickEvent>,
    has_sticks: bool,
}

/// What the controls say at one moment.
pub enum Said {
    Wish(Wish),
    /// The user wants to end.
    End,
}

impl Controls {
    /// `has_sticks` says whether height, roll and jump are wanted too.
    pub fn open(joystick: Option<&Path>, map: JoystickMap, has_sticks: bool) -> Result<Self> {
        if joystick.is_some() && !cfg!(target_os = "linux") {
            bail!("joysticks work on Linux only: leave out --joystick and use the keyboard");
        }
        let joystick = joystick.map(|path| Joystick::open(path, map)).transpose()?;
        let has_terminal = stdin().is_terminal() && stdout().is_terminal();
        ensure!(
            joystick.is_some() || has_terminal,
            "there is no terminal to read keys from: run this in one, or name a --joystick"
        );
        let keys = has_terminal.then(|| Keys::take(has_sticks)).transpose();
        let keys = keys.context("the terminal gives no single keys")?;
        Ok(Self {
            keys,
            joystick,
            map,
            last_event: None,
            has_sticks,
        })
    }

    /// Reads keys and joystick. With a joystick, keys of direction have no effect.
    pub fn read(&mut self, now: Duration) -> Result<Said> {
        if let Some(keys) = &mut self.keys
            && keys.poll(now)?
        {
            return Ok(Said::End);
        }
        let last_event = &mut self.last_event;
        let wish = match (&mut self.joystick, &self.keys) {
            (Some(joystick), _) => joystick.wish(|event| *last_event = Some(event))?,
            (None, Some(keys)) => keys.keyboard().wish(now),
            (None, None) => Wish::NONE,
        };
        Ok(Said::Wish(wish))
    }

    pub fn has_terminal(&self) -> bool {
        self.keys.is_some()
    }

    /// Returns lines on what the user can do.
    pub fn help(&self) -> Vec<String> {
        let keys = "keys      hold W S A D or arrows to drive and turn, Q E for both; Space stops, Esc ends";
        let mut lines = match (&self.joystick, &self.keys) {
            (Some(_), _) => joystick_help(&self.map, self.has_sticks),
            (None, Some(taken)) if taken.keyboard().reports_release() => vec![keys.to_owned()],
            (None, _) => vec![
                keys.to_owned(),
                "          stops up to 0.2 s after you let go, 0.7 s after a tap".to_owned(),
            ],
        };
        if self.has_sticks && self.joystick.is_none() {
            lines.push(
                "          R F lengthen and shorten the legs, Z C tilt left and right, J jumps"
                    .to_owned(),
            );
        }
        lines.extend(self.last_event.map(said));
        lines
    }
}

fn joystick_help(map: &JoystickMap, has_sticks: bool) -> Vec<String> {
    let mut lines = vec![format!(
        "joystick  hold button {}, the dead-man: axis {} drives, axis {} turns; Esc ends",
        map.dead_man, map.forward.number, map.turn.number
    )];
    if has_sticks {
        lines.push(format!(
            "          axis {} sets the height, axis {} the roll, button {} jumps",
            map.height.number, map.roll.number, map.jump
        ));
    }
    lines
}

fn said(event: JoystickEvent) -> String {
    match event {
        JoystickEvent::Button { number, is_down } => {
            let word = if is_down { "pressed" } else { "let go" };
            format!("          button {number} {word}")
        }
        JoystickEvent::Axis { number, value } => format!("          axis {number} at {value:+.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_names_the_axes_and_buttons_of_the_map() {
        let map = "forward=11,turn=12-,dead-man=13,height=14,roll=15,jump=16";
        let map: JoystickMap = map.parse().expect("a map");
        let [drives, stands] = &joystick_help(&map, true)[..] else {
            panic!("two lines");
        };
        assert_eq!(
            drives,
            "joystick  hold button 13, the dead-man: axis 11 drives, axis 12 turns; Esc ends"
        );
        assert_eq!(
            stands,
            "          axis 14 sets the height, axis 15 the roll, button 16 jumps"
        );
        assert_eq!(joystick_help(&map, false), std::slice::from_ref(drives));
    }
}
