//! Shows how the drive goes: a screen on a terminal, else a line whenever something changes.

use std::io::{Write, stdout};

use anyhow::Result;
use crossterm::{
    cursor::{Hide, MoveTo, Show},
    execute, queue,
    style::{Attribute, Print, SetAttribute},
    terminal::{Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen},
};

use crate::command::output::say;

pub struct Screen {
    /// False without a terminal.
    is_full: bool,
    last_headline: String,
}

impl Screen {
    pub fn open(is_full: bool) -> Result<Self> {
        let screen = Self {
            is_full,
            last_headline: String::new(),
        };
        if is_full {
            execute!(stdout(), EnterAlternateScreen, Hide)?;
        }
        Ok(screen)
    }

    /// Shows the headline, and on a terminal the lines below it.
    pub fn show(&mut self, headline: &str, lines: &[String]) -> Result<()> {
        if !self.is_full {
            if headline != self.last_headline {
                say!("{headline}")?;
                self.last_headline = headline.to_owned();
            }
            return Ok(());
        }
        let mut output = stdout().lock();
        queue!(
            output,
            MoveTo(0, 0),
            SetAttribute(Attribute::Bold),
            Print(headline),
            SetAttribute(Attribute::Reset),
            Clear(ClearType::UntilNewLine),
        )?;
        for line in lines {
            queue!(
                output,
                Print("\r\n"),
                Print(line),
                Clear(ClearType::UntilNewLine)
            )?;
        }
        queue!(output, Clear(ClearType::FromCursorDown))?;
        Ok(output.flush()?)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if self.is_full {
            // A terminal that is gone needs nothing of this.
            let _ = execute!(stdout(), Show, LeaveAlternateScreen);
        }
    }
}
