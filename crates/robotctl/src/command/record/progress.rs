//! Shows how a recording goes, and says when it ends.

use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

use crate::command::interrupt::Interrupt;

/// How long to wait for the next frame before looking whether to end.
const LOOK: Duration = Duration::from_millis(100);
const REPAINT: Duration = Duration::from_millis(200);
/// Without any frame for this long, the user gets to know it.
const QUIET: Duration = Duration::from_secs(1);

pub struct Progress {
    bar: ProgressBar,
    interrupt: Interrupt,
    started: Instant,
    length: Option<Duration>,
    painted: Instant,
    heard: Instant,
}

impl Progress {
    pub fn start(seconds: Option<u32>) -> Result<Self> {
        let (bar, template) = match seconds {
            Some(seconds) => (
                ProgressBar::new(seconds.into()),
                "recording {bar:30} {pos} of {len} s  {msg}",
            ),
            None => (
                ProgressBar::new_spinner(),
                "recording {pos} s, end with Ctrl-C  {msg}",
            ),
        };
        bar.set_style(ProgressStyle::with_template(template)?);
        let now = Instant::now();
        Ok(Self {
            bar,
            interrupt: Interrupt::catch()?,
            started: now,
            length: seconds.map(|s| Duration::from_secs(s.into())),
            painted: now,
            heard: now,
        })
    }

    /// Returns until when to wait for the next frame, or `None` at the end.
    pub fn next_deadline(&self) -> Option<Instant> {
        let now = Instant::now();
        let end = self.length.map(|length| self.started + length);
        let is_over = self.interrupt.is_caught() || end.is_some_and(|end| now >= end);
        (!is_over).then(|| end.map_or(now + LOOK, |end| end.min(now + LOOK)))
    }

    pub fn heard(&mut self) {
        self.heard = Instant::now();
    }

    /// Shows the words that `say` gives, at times.
    pub fn show(&mut self, say: impl FnOnce() -> String) {
        if self.painted.elapsed() < REPAINT {
            return;
        }
        self.painted = Instant::now();
        let silence = self.heard.elapsed();
        let words = match silence > QUIET {
            true => format!("{}; nothing for {} s", say(), silence.as_secs()),
            false => say(),
        };
        self.bar.set_position(self.started.elapsed().as_secs());
        self.bar.set_message(words);
    }

    pub fn end(self) {
        self.bar.finish_and_clear();
    }
}
