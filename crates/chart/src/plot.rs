//! Line plots over time, the path on the ground, and histograms, as SVG text.

use std::ops::Range;

use plotters::{
    coord::Shift,
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use crate::{ChartError, Legend};

pub const WIDTH: u32 = 980;

/// Colours that colour-blind readers can tell apart (Okabe and Ito).
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const ORANGE: RGBColor = RGBColor(213, 94, 0);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const PURPLE: RGBColor = RGBColor(170, 80, 150);
pub const GREY: RGBColor = RGBColor(120, 120, 120);
const INK: RGBColor = RGBColor(50, 55, 60);
const GRID: RGBColor = RGBColor(225, 228, 232);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub struct Curve {
    pub label: String,
    pub colour: RGBColor,
    /// Drawn thin and light, under the others: a reference or command.
    pub faint: bool,
    pub points: Vec<(f64, Option<f64>)>,
}

impl Curve {
    fn has_points(&self) -> bool {
        self.points.iter().any(|p| p.1.is_some())
    }

    /// Unbroken pieces: a gap in the values is a gap in the line.
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
    /// Instants at which something is done from outside.
    pub marks: &'a [f64],
    /// Spans on a tinted ground.
    pub shaded: &'a [Range<f64>],
    pub curves: Vec<Curve>,
}

impl TimePlot<'_> {
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

    /// `None` if no curve has a value.
    pub fn draw(&self) -> Result<Option<String>, ChartError> {
        if !self.curves.iter().any(Curve::has_points) {
            return Ok(None);
        }
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, (WIDTH, self.height)).into_drawing_area();
        self.draw_on(&area).map_err(ChartError::new)?;
        drop(area);
        Ok(Some(svg))
    }

    fn draw_on<'b>(
        &self,
        area: &Area<'b>,
    ) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'b> as DrawingBackend>::ErrorType>> {
        let values = self.curves.iter().flat_map(|c| &c.points);
        let range = padded(values.filter_map(|p| p.1));
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(26)
            .y_label_area_size(64)
            .build_cartesian_2d(self.time.clone(), range.clone())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(GREY)
            .y_desc(self.unit)
            .label_style(label_style())
            .x_labels(12)
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

pub fn label_style() -> TextStyle<'static> {
    TextStyle::from(("sans-serif", 15).into_font())
        .color(&INK)
        .pos(Pos::new(HPos::Left, VPos::Top))
}

/// Values all smaller than this are shown as zero.
const NOTHING: f64 = 1e-6;

/// A range around all finite values, with room above and below; never empty, and no smaller than its labels can tell
/// where everything is zero.
fn padded(values: impl Iterator<Item = f64>) -> Range<f64> {
    let finite = values.filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    if low > high {
        return 0.0..1.0;
    }
    let size = high.abs().max(low.abs());
    if size < NOTHING {
        return -1.0..1.0;
    }
    let room = ((high - low) * 0.08).max(size * 1e-3);
    low - room..high + room
}

/// A path on the ground seen from above, both axes at one scale.
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
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, (SIDE, SIDE)).into_drawing_area();
    let draw = || {
        let mut chart = ChartBuilder::on(&area)
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
    };
    draw().map_err(|e: DrawingAreaErrorKind<_>| ChartError::new(e))?;
    drop(area);
    Ok(svg)
}

/// Counts in bins of equal width starting at 0, on a logarithmic scale.
pub fn draw_histogram(bins: &[u64], bin_width: f64, unit: &str) -> Result<String, ChartError> {
    let used = bins.iter().rposition(|n| *n > 0).map_or(1, |last| last + 1);
    let highest = bins.iter().copied().max().unwrap_or(1).max(1) as f64;
    let width = bin_width * used.max(8) as f64;
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, (WIDTH, 240)).into_drawing_area();
    let draw = || {
        let mut chart = ChartBuilder::on(&area)
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
    };
    draw().map_err(|e: DrawingAreaErrorKind<_>| ChartError::new(e))?;
    drop(area);
    Ok(svg)
}
