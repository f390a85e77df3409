//! Shows a recording as an HTML page.

mod black_box;
mod can;
mod messages;
mod series;
mod state;
mod table;

use std::path::{Path, PathBuf};

use robot_chart::{ChartError, document, header, paragraph};

use crate::{black_box::EVENT_TOPIC, recording::RecordingError};
pub use black_box::event_page;
use messages::Messages;

#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    #[error("cannot read {path}")]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{path} is no readable MCAP file")]
    Mcap {
        path: PathBuf,
        source: mcap::McapError,
    },
    #[error(
        "{path} holds neither a state of the robot nor frames of a CAN bus (topics: {topics}); a run of `cargo xtask sim` \
         has its plots in the report.html beside it"
    )]
    Unknown { path: PathBuf, topics: String },
    #[error(
        "{path} is an event of the black box; its page is {page}, which `robotctl blackbox` wrote with it"
    )]
    BlackBox { path: PathBuf, page: PathBuf },
    #[error(transparent)]
    Table(#[from] RecordingError),
    #[error(transparent)]
    Chart(#[from] ChartError),
}

/// What a page shows below its title.
struct Content {
    /// One line on the whole recording.
    summary: String,
    /// HTML, made by `robot_chart`.
    body: String,
}

/// Returns the page that shows a recording: an MCAP file of `robotctl record`, or a table for calibration.
pub fn page(path: &Path) -> Result<String, PlotError> {
    let is_mcap = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"));
    let content = if is_mcap {
        of_mcap(path)?
    } else {
        table::content(path)?
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let body = header(&name, &content.summary) + &content.body;
    Ok(document(&name, &body))
}

fn of_mcap(path: &Path) -> Result<Content, PlotError> {
    let bytes = std::fs::read(path).map_err(|source| PlotError::File {
        path: path.to_owned(),
        source,
    })?;
    let messages = Messages::read(&bytes).map_err(|source| PlotError::Mcap {
        path: path.to_owned(),
        source,
    })?;
    let content = if !messages.states.is_empty() {
        state::content(&messages)?
    } else if !messages.can.is_empty() {
        can::content(&messages)?
    } else if messages.topics.contains(EVENT_TOPIC) {
        return Err(PlotError::BlackBox {
            path: path.to_owned(),
            page: path.with_extension("html"),
        });
    } else {
        let topics: Vec<&str> = messages.topics.iter().map(String::as_str).collect();
        return Err(PlotError::Unknown {
            path: path.to_owned(),
            topics: topics.join(", "),
        });
    };
    if !messages.is_cut_off {
        return Ok(content);
    }
    let note = "The file has no end: the recording was killed, or is still going on. All that it has is shown.";
    Ok(Content {
        body: paragraph(note) + &content.body,
        ..content
    })
}

#[cfg(test)]
mod tests;
