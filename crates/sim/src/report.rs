//! `report.html`: one self-contained page with the verdict, the plots and the log.

mod animation;
mod attitude;
mod page;
mod plots;
mod shape;

#[cfg(test)]
mod tests;

use robot_chart::ChartError;

use super::{runner::RunResult, scenario::Scenario, summary::Summary, trace::Traces};

/// Everything that goes into a report.
pub struct Report<'a> {
    pub scenario: &'a Scenario,
    pub result: &'a RunResult,
    pub summary: &'a Summary,
    pub traces: &'a Traces,
}

pub fn render(report: &Report) -> Result<String, ChartError> {
    let figures = plots::all(report)?;
    Ok(page::page(report, &figures))
}
