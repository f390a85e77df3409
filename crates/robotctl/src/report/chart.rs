//! Points before and after the correction, as SVG text.

use plotters::{coord::Shift, prelude::*};

use super::ReportError;

/// Colours that colour-blind readers can tell apart (Okabe and Ito).
const BEFORE: RGBColor = RGBColor(213, 94, 0);
const AFTER: RGBColor = RGBColor(0, 114, 178);
const GREY: RGBColor = RGBColor(120, 120, 120);
const GRID: RGBColor = RGBColor(225, 228, 232);
const WIDTH: u32 = 980;
const ERRORS_HEIGHT: u32 = 260;
const SQUARE: u32 = WIDTH / 3;
/// Points drawn of one series; more only make the file large.
const MAX_POINTS: usize = 1_500;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawError<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

/// One pair of dots for each numbered position.
pub(super) fn errors(before: &[f64], after: &[f64], unit: &str) -> Result<String, ReportError> {
    drawing(ERRORS_HEIGHT, |area| {
        let highest = before
            .iter()
            .chain(after)
            .fold(1e-3, |h: f64, v| h.max(v.abs()))
            * 1.15;
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(64)
            .build_cartesian_2d(0.5..before.len() as f64 + 0.5, -highest..highest)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(GREY)
            .x_desc("position")
            .y_desc(unit)
            .x_labels(before.len().clamp(2, 20))
            .x_label_formatter(&|n| format!("{n:.0}"))
            .draw()?;
        for (errors, colour) in [(before, BEFORE), (after, AFTER)] {
            let dots = (1..).zip(errors).map(|(n, error)| (f64::from(n), *error));
            chart.draw_series(dots.map(|at| Circle::new(at, 5, colour.filled())))?;
        }
        Ok(())
    })
}

/// Points in three dimensions.
pub(super) struct Cloud<'a> {
    pub before: &'a [[f64; 3]],
    pub after: &'a [[f64; 3]],
    /// Radius of the sphere they should lie on.
    pub radius: f64,
}

/// Seen along each of the three axes, all at one scale.
pub(super) fn projections(cloud: &Cloud, unit: &str) -> Result<String, ReportError> {
    let all = cloud.before.iter().chain(cloud.after).flatten();
    let reach = 1.05 * all.fold(cloud.radius, |r, v| r.max(v.abs()));
    drawing(SQUARE, |area| {
        let planes = [(0, 1), (0, 2), (1, 2)];
        for (part, plane) in area.split_evenly((1, 3)).iter().zip(planes) {
            projection(part, cloud, plane, reach, unit)?;
        }
        Ok(())
    })
}

fn projection<'b>(
    area: &Area<'b>,
    cloud: &Cloud,
    (across, up): (usize, usize),
    reach: f64,
    unit: &str,
) -> Result<(), DrawError<'b>> {
    let names = ["x", "y", "z"];
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(34)
        .y_label_area_size(46)
        .build_cartesian_2d(-reach..reach, -reach..reach)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(GREY)
        .x_labels(5)
        .y_labels(5)
        .x_desc(format!("{}, {unit}", names[across]))
        .y_desc(format!("{}, {unit}", names[up]))
        .draw()?;
    for (points, colour) in [(cloud.before, BEFORE), (cloud.after, AFTER)] {
        let step = points.len().div_ceil(MAX_POINTS).max(1);
        let dots = points.iter().step_by(step).map(|p| (p[across], p[up]));
        chart.draw_series(dots.map(|at| Circle::new(at, 1, colour.mix(0.5).filled())))?;
    }
    let circle = (0..=90).map(|n| {
        let (sin, cos) = (f64::from(n) * std::f64::consts::TAU / 90.0).sin_cos();
        (cloud.radius * cos, cloud.radius * sin)
    });
    chart.draw_series(LineSeries::new(circle, GREY.stroke_width(1)))?;
    Ok(())
}

fn drawing(
    height: u32,
    draw: impl for<'b> FnOnce(&Area<'b>) -> Result<(), DrawError<'b>>,
) -> Result<String, ReportError> {
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
    draw(&area).map_err(ReportError::new)?;
    drop(area);
    Ok(svg)
}
