//! Plots of lines over time, of a path on the ground, and histograms.

use std::ops::Range;

use plotters::prelude::*;

use crate::{
    BLUE, ChartError, GREEN, GREY, Legend, ORANGE, WIDTH,
    canvas::{self, Area, DrawError, GRID},
    label_style,
};

/// One line of a plot.
pub struct Curve {
    pub label: String,
    pub colour: RGBColor,
    /// Drawn broad and light: a reference or a command.
    pub faint: bool,
    /// Time and value; `None` leaves a gap in the line.
    pub points: Vec<(f64, Option<f64>)>,
}

impl Curve {
    fn has_points(&self) -> bool {
        self.points.iter().any(|p| p.1.is_some())
    }

    /// Returns the pieces of the line between its gaps.
    fn pieces(&self) -> impl Iterator<Item = Vec<(f64, f64)>> + '_ {
        self.points
            .split(|(_, v)| v.is_none_or(|v| !v.is_finite()))
            .filter(|piece| !piece.is_empty())
            .map(|piece| {
                piece
                    .iter()
                    .filter_map(|(t, v)| Some((*t, (*v)?)))
                    .collect()
            })
    }
}

/// Lines over time.
pub struct TimePlot<'a> {
    pub unit: &'a str,
    pub height: u32,
    pub time: Range<f64>,
    /// Instants marked by a dashed line, such as those of a scenario's actions.
    pub marks: &'a [f64],
    /// Spans of time with a tinted background.
    pub shaded: &'a [Range<f64>],
    pub curves: Vec<Curve>,
}

impl TimePlot<'_> {
    /// Lists the curves that have a value.
    pub fn legend(&self) -> Vec<Legend> {
        let drawn = self.curves.iter().filter(|c| c.has_points());
        drawn
            .map(|curve| Legend {
                label: curve.label.clone(),
                colour: curve.colour,
                faint: curve.faint,
            })
            .collect()
    }

    /// Draws the plot as SVG text; `None` if no curve has a value.
    pub fn draw(&self) -> Result<Option<String>, ChartError> {
        if !self.curves.iter().any(Curve::has_points) {
            return Ok(None);
        }
        canvas::svg((WIDTH, self.height), |area| self.draw_on(area)).map(Some)
    }

    fn draw_on<'b>(&self, area: &Area<'b>) -> Result<(), DrawError<'b>> {
        let values = self.curves.iter().flat_map(|c| &c.points);
        let range = padded(values.filter_map(|p| p.1));
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(26)
            .y_label_area_size(UNIT_AND_LABELS)
            .build_cartesian_2d(self.time.clone(), range.clone())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(GREY)
            .y_desc(self.unit)
            .label_style(label_style())
            .x_labels(12)
            .x_label_formatter(&canvas::seconds)
            .y_labels(6)
            .draw()?;
        let tint = BLUE.mix(0.07).filled();
        chart.draw_series(self.shaded.iter().map(|span| {
            Rectangle::new([(span.start, range.start), (span.end, range.end)], tint)
        }))?;
        for mark in self.marks {
            let line = [(*mark, range.start), (*mark, range.end)];
            chart.draw_series(DashedLineSeries::new(
                line,
                3,
                4,
                GREY.mix(0.5).stroke_width(1),
            ))?;
        }
        for curve in &self.curves {
            let (width, opacity) = if curve.faint { (4, 0.35) } else { (2, 1.0) };
            let style = curve.colour.mix(opacity).stroke_width(width);
            for piece in curve.pieces() {
                chart.draw_series(LineSeries::new(piece, style))?;
            }
        }
        Ok(())
    }
}

/// Room for the unit and labels of eight characters beside each other, in pixels.
const UNIT_AND_LABELS: u32 = 90;
/// Values smaller than this are shown as zero.
const SHOWN_AS_ZERO: f64 = 1e-6;
/// A range is at least this wide, and this share of its values. Labels have five decimals, so they differ then, and the
/// noise of a value that stands still looks like it.
const LEAST_SPAN: f64 = 0.02;
const LEAST_SHARE: f64 = 0.005;

/// Returns a range around all finite values, with room above and below. It is wide enough for its labels to differ.
pub(crate) fn padded(values: impl Iterator<Item = f64>) -> Range<f64> {
    let finite = values.filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    if low > high {
        return 0.0..1.0;
    }
    let size = high.abs().max(low.abs());
    if size < SHOWN_AS_ZERO {
        return -1.0..1.0;
    }
    let least = LEAST_SPAN.max(size * LEAST_SHARE);
    let room = ((high - low) * 0.08).max(0.5 * (least - (high - low)));
    low - room..high + room
}

/// Draws a path on the ground seen from above, both axes at one scale.
pub fn draw_path(points: &[(f64, f64)], unit: &str) -> Result<String, ChartError> {
    const SIDE: u32 = 520;
    let (x, y) = (
        padded(points.iter().map(|p| p.0)),
        padded(points.iter().map(|p| p.1)),
    );
    let half = 0.5 * (x.end - x.start).max(y.end - y.start).max(0.2);
    let around = |r: &Range<f64>| {
        let middle = 0.5 * (r.start + r.end);
        middle - half..middle + half
    };
    canvas::svg((SIDE, SIDE), |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(58)
            .build_cartesian_2d(around(&x), around(&y))?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(GREY)
            .label_style(label_style())
            .x_desc(format!("x, {unit}"))
            .y_desc(format!("y, {unit}"))
            .draw()?;
        chart.draw_series(LineSeries::new(
            points.iter().copied(),
            BLUE.stroke_width(2),
        ))?;
        let ends = [(points.first(), GREEN), (points.last(), ORANGE)];
        chart.draw_series(
            ends.into_iter()
                .filter_map(|(p, colour)| Some(Circle::new(*p?, 5, colour.filled()))),
        )?;
        Ok(())
    })
}

/// Draws counts in bins of equal width that start at 0, on a logarithmic scale.
pub fn draw_histogram(bins: &[u64], bin_width: f64, unit: &str) -> Result<String, ChartError> {
    let used = bins.iter().rposition(|n| *n > 0).map_or(1, |last| last + 1);
    let highest = bins.iter().copied().max().unwrap_or(1).max(1) as f64;
    let width = bin_width * used.max(8) as f64;
    canvas::svg((WIDTH, 240), |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(40)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..width, (0.5..highest * 2.0).log_scale())?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(GREY)
            .label_style(label_style())
            .x_desc(unit)
            .y_desc("ticks")
            .y_label_formatter(&|n| format!("{n:.0}"))
            .draw()?;
        let bars = bins
            .iter()
            .enumerate()
            .filter(|(_, n)| **n > 0)
            .map(|(i, n)| {
                let left = i as f64 * bin_width;
                let corners = [(left, 0.5), (left + bin_width * 0.9, *n as f64)];
                Rectangle::new(corners, BLUE.mix(0.8).filled())
            });
        chart.draw_series(bars)?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The labels are the texts of the drawing.
    fn labels(value: f64) -> Vec<String> {
        let plot = TimePlot {
            unit: "",
            height: 220,
            time: 0.0..2.0,
            marks: &[],
            shaded: &[],
            curves: vec![Curve {
                label: String::new(),
                colour: BLUE,
                faint: false,
                points: vec![(0.0, Some(value)), (2.0, Some(value))],
            }],
        };
        let svg = plot.draw().unwrap().unwrap();
        let lines = svg.lines().map(str::trim);
        lines
            .filter(|line| !line.is_empty() && !line.starts_with('<'))
            .map(str::to_owned)
            .collect()
    }

    #[test]
    fn the_labels_of_a_constant_differ() {
        for value in [0.0, 0.0005, -0.25, 24.0, 12_345.0] {
            let labels = labels(value);
            let different: std::collections::BTreeSet<_> = labels.iter().collect();
            assert!(labels.len() > 10, "{value}: {labels:?}");
            assert_eq!(different.len(), labels.len(), "{value}: {labels:?}");
        }
    }
}
