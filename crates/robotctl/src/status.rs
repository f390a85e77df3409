//! What the robot is doing and what keeps it from being armed: live pages, put into words or JSON.

mod advice;
mod json;
mod text;

pub use text::strange_sectors;

use crate::tuning::{BootFindings, LiveReading, StoreReport, TuningClient, TuningError};

/// All that one look at the robot shows.
#[derive(Clone, Debug)]
pub struct Status {
    pages: Vec<LiveReading>,
    /// `None` from a firmware that saves nothing.
    store: Option<StoreReport>,
    findings: Option<BootFindings>,
}

impl Status {
    /// One page after the other: they need not be of the same moment.
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
