//! `report.html`: one self-contained page with the verdict, the plots and the log.

mod attitude;
mod chart;
mod lanes;
mod page;
mod plots;

#[cfg(test)]
mod tests;

use plotters::style::RGBColor;

use super::{runner::RunResult, scenario::Scenario, summary::Summary, trace::Traces};

/// What a report is made of.
pub struct Report<'a> {
    pub scenario: &'a Scenario,
    pub result: &'a RunResult,
    pub summary: &'a Summary,
    pub traces: &'a Traces,
}

#[derive(Debug, thiserror::Error)]
#[error("cannot draw a plot: {0}")]
pub struct ReportError(String);

impl ReportError {
    fn new(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// A drawn plot with its heading.
struct Figure {
    title: &'static str,
    /// What the reader should look for.
    caption: &'static str,
    legend: Vec<Legend>,
    svg: String,
}

struct Legend {
    label: String,
    colour: RGBColor,
    faint: bool,
}

pub fn render(report: &Report) -> Result<String, ReportError> {
    let figures = plots::all(report)?;
    Ok(page::page(report, &figures))
}
