//! The terminal of the screens.

use std::{
    io::{IsTerminal, stdin, stdout},
    time::Duration,
};

use anyhow::{Result, ensure};
use ratatui::{
    DefaultTerminal,
    crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers},
    text::Line,
    widgets::{Block, Paragraph, Wrap},
};

/// A screen. The terminal is restored when it is dropped, and in a panic.
pub struct Screen {
    terminal: DefaultTerminal,
}

impl Screen {
    pub fn open() -> Result<Self> {
        ensure!(
            stdin().is_terminal() && stdout().is_terminal(),
            "there is no terminal to read keys from: run this in one"
        );
        let terminal = ratatui::try_init()?;
        Ok(Self { terminal })
    }

    /// Returns the keys since the last call: characters in lower case, Enter as a line feed, Esc and Ctrl-C as an escape.
    pub fn keys(&mut self) -> Result<Vec<char>> {
        let mut keys = Vec::new();
        while event::poll(Duration::ZERO)? {
            let Event::Key(key) = event::read()? else {
                continue;
            };
            if key.kind == KeyEventKind::Release {
                continue;
            }
            let is_ctrl = key.modifiers.contains(KeyModifiers::CONTROL);
            match key.code {
                KeyCode::Char('c' | 'C') if is_ctrl => keys.push('\x1b'),
                KeyCode::Char(key) => keys.extend(key.to_lowercase()),
                KeyCode::Enter => keys.push('\n'),
                KeyCode::Esc => keys.push('\x1b'),
                _ => {}
            }
        }
        Ok(keys)
    }

    pub fn draw(&mut self, title: &str, lines: &[String]) -> Result<()> {
        self.terminal.draw(|frame| {
            let lines: Vec<Line> = lines.iter().map(|line| Line::from(line.as_str())).collect();
            let page = Paragraph::new(lines)
                .block(Block::bordered().title(title))
                // Messages are whole sentences, and the cure is at their end.
                .wrap(Wrap { trim: false });
            frame.render_widget(page, frame.area());
        })?;
        Ok(())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // A terminal that is gone needs nothing of this.
        let _ = ratatui::try_restore();
    }
}
