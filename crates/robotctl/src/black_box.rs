//! The robot's black box: the last seconds around each stop that nobody asked for (docs/black-box.md).

mod download;
mod event;
mod file;
mod json;
mod names;
mod release;
mod story;

pub use download::{Bank, DownloadError, contents, download};
pub use event::RecordedEvent;
pub use file::{EVENT_TOPIC, SAMPLE_TOPIC, write};
pub use json::summary;
pub use release::{ReleaseTimeouts, release};
pub use story::{first_sentence, paragraphs};

#[cfg(test)]
mod tests;
