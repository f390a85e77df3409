//! Shows what the robot does and what keeps it from being armed. It puts live pages into words or JSON.

mod advice;
mod json;
mod text;

pub use text::strange_sectors;

use crate::tuning::{BootFindings, LiveReading, StoreReport, TuningClient, TuningError};

/// The state of the robot: all live pages and the report on saved settings.
#[derive(Clone, Debug)]
pub struct Status {
    pages: Vec<LiveReading>,
    /// `None` from a firmware that saves nothing.
    store: Option<StoreReport>,
    findings: Option<BootFindings>,
}

impl Status {
    /// Reads one page after the other, so they may be from different moments.
    pub fn read(client: &mut TuningClient) -> Result<Self, TuningError> {
        Ok(Self {
            pages: client.live_all()?,
            store: client.store()?,
            findings: client.boot_findings()?,
        })
    }

    /// True if the firmware is too old to show anything.
    pub fn is_empty(&self) -> bool {
        self.pages.is_empty()
    }

    fn page(&self, name: &str) -> Option<&LiveReading> {
        self.part(name, 0)
    }

    fn part(&self, name: &str, part: usize) -> Option<&LiveReading> {
        let mut pages = self.pages.iter();
        pages.find(|reading| reading.page.name == name && reading.part == part)
    }
}

#[cfg(test)]
mod tests;
