//! The keys of the terminal.

use std::{
    io::{self, stdout},
    time::Duration,
};

use crossterm::{
    event::{
        self, DisableFocusChange, EnableFocusChange, Event, KeyCode, KeyEvent, KeyEventKind,
        KeyModifiers, KeyboardEnhancementFlags, PopKeyboardEnhancementFlags,
        PushKeyboardEnhancementFlags,
    },
    execute, terminal,
};

use super::{Direction, Keyboard};

/// The terminal without line editing. It is restored when this is dropped.
pub struct Keys {
    keyboard: Keyboard,
    is_enhanced: bool,
    has_sticks: bool,
}

impl Keys {
    /// `has_sticks` says whether keys for height, roll and jump count too.
    pub fn take(has_sticks: bool) -> io::Result<Self> {
        terminal::enable_raw_mode()?;
        // Made at once, so that an error below restores the terminal.
        let mut keys = Self {
            keyboard: Keyboard::new(cfg!(windows)),
            is_enhanced: false,
            has_sticks,
        };
        if terminal::supports_keyboard_enhancement().unwrap_or(false) {
            let flags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
                | KeyboardEnhancementFlags::REPORT_EVENT_TYPES;
            execute!(stdout(), PushKeyboardEnhancementFlags(flags))?;
            keys.is_enhanced = true;
            keys.keyboard = Keyboard::new(true);
        }
        execute!(stdout(), EnableFocusChange)?;
        Ok(keys)
    }

    pub fn keyboard(&self) -> &Keyboard {
        &self.keyboard
    }

    /// Takes what was typed. Returns true if the user wants to end.
    pub fn poll(&mut self, now: Duration) -> io::Result<bool> {
        while event::poll(Duration::ZERO)? {
            match event::read()? {
                Event::Key(key) if self.key(key, now) => return Ok(true),
                Event::FocusLost => self.keyboard.release_all(),
                _ => {}
            }
        }
        Ok(false)
    }

    fn key(&mut self, key: KeyEvent, now: Duration) -> bool {
        let is_down = key.kind != KeyEventKind::Release;
        let standing = |code| self.has_sticks.then(|| standing(code)).flatten();
        if let Some(direction) = direction(key.code).or_else(|| standing(key.code)) {
            match is_down {
                true => self.keyboard.press(direction, now),
                false => self.keyboard.release(direction, now),
            }
            return false;
        }
        if !is_down {
            return false;
        }
        // Any other key stops the robot.
        self.keyboard.release_all();
        let is_ctrl_c = key.modifiers.contains(KeyModifiers::CONTROL)
            && matches!(key.code, KeyCode::Char('c' | 'C'));
        is_ctrl_c || key.code == KeyCode::Esc
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        // A terminal that is gone needs nothing of this.
        if self.is_enhanced {
            let _ = execute!(stdout(), PopKeyboardEnhancementFlags);
        }
        let _ = execute!(stdout(), DisableFocusChange);
        let _ = terminal::disable_raw_mode();
    }
}

fn direction(code: KeyCode) -> Option<Direction> {
    match code {
        KeyCode::Up | KeyCode::Char('w' | 'W') => Some(Direction::Forward),
        KeyCode::Down | KeyCode::Char('s' | 'S') => Some(Direction::Backward),
        KeyCode::Left | KeyCode::Char('a' | 'A') => Some(Direction::Left),
        KeyCode::Right | KeyCode::Char('d' | 'D') => Some(Direction::Right),
        KeyCode::Char('q' | 'Q') => Some(Direction::ForwardLeft),
        KeyCode::Char('e' | 'E') => Some(Direction::ForwardRight),
        _ => None,
    }
}

/// The keys for a robot that stands.
fn standing(code: KeyCode) -> Option<Direction> {
    match code {
        KeyCode::Char('r' | 'R') => Some(Direction::Higher),
        KeyCode::Char('f' | 'F') => Some(Direction::Lower),
        KeyCode::Char('z' | 'Z') => Some(Direction::LeftDown),
        KeyCode::Char('c' | 'C') => Some(Direction::RightDown),
        KeyCode::Char('j' | 'J') => Some(Direction::Jump),
        _ => None,
    }
}
