//! Dots before and after a correction.

use plotters::prelude::*;

use crate::{
    BLUE, ChartError, GREY, Legend, ORANGE, WIDTH,
    canvas::{self, Area, DrawError, GRID},
    label_style,
};

const BEFORE: RGBColor = ORANGE;
const AFTER: RGBColor = BLUE;
const RESIDUALS_HEIGHT: u32 = 260;
const PROJECTIONS_HEIGHT: u32 = WIDTH / 3;
/// At most this many points of a series are drawn, because more would only make the file larger.
const MAX_POINTS: usize = 1_500;

/// The legend of the drawings in this file.
pub fn before_and_after() -> Vec<Legend> {
    let legend = |label: &str, colour| Legend {
        label: label.to_owned(),
        colour,
        faint: false,
    };
    vec![legend("as measured", BEFORE), legend("corrected", AFTER)]
}

/// Draws the residual of each numbered measurement, one dot before and one after the correction.
pub fn draw_residuals(before: &[f64], after: &[f64], unit: &str) -> Result<String, ChartError> {
    let all = before.iter().chain(after);
    let highest = 1.15 * all.fold(1e-3, |highest: f64, value| highest.max(value.abs()));
    canvas::svg((WIDTH, RESIDUALS_HEIGHT), |area| {
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
            .label_style(label_style())
            .x_desc("position")
            .y_desc(unit)
            .x_labels(before.len().clamp(2, 20))
            .x_label_formatter(&|n| format!("{n:.0}"))
            .draw()?;
        for (residuals, colour) in [(before, BEFORE), (after, AFTER)] {
            let dots = (1..)
                .zip(residuals)
                .map(|(n, value)| (f64::from(n), *value));
            chart.draw_series(dots.map(|at| Circle::new(at, 5, colour.filled())))?;
        }
        Ok(())
    })
}

/// Points in three dimensions that should lie on a sphere.
pub struct Cloud<'a> {
    pub before: &'a [[f64; 3]],
    pub after: &'a [[f64; 3]],
    /// Radius of the sphere around the origin.
    pub radius: f64,
}

impl Cloud<'_> {
    /// Draws the points as seen along each of the three axes, all at one scale.
    pub fn draw(&self, unit: &str) -> Result<String, ChartError> {
        let all = self.before.iter().chain(self.after).flatten();
        let reach = 1.05 * all.fold(self.radius, |reach, value| reach.max(value.abs()));
        canvas::svg((WIDTH, PROJECTIONS_HEIGHT), |area| {
            let planes = [(0, 1), (0, 2), (1, 2)];
            for (part, plane) in area.split_evenly((1, 3)).iter().zip(planes) {
                self.draw_projection(part, plane, reach, unit)?;
            }
            Ok(())
        })
    }

    fn draw_projection<'a>(
        &self,
        area: &Area<'a>,
        (across, up): (usize, usize),
        reach: f64,
        unit: &str,
    ) -> Result<(), DrawError<'a>> {
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
            .label_style(label_style())
            .x_labels(5)
            .y_labels(5)
            .x_desc(format!("{}, {unit}", names[across]))
            .y_desc(format!("{}, {unit}", names[up]))
            .draw()?;
        for (points, colour) in [(self.before, BEFORE), (self.after, AFTER)] {
            let step = points.len().div_ceil(MAX_POINTS).max(1);
            let dots = points.iter().step_by(step).map(|p| (p[across], p[up]));
            chart.draw_series(dots.map(|at| Circle::new(at, 1, colour.mix(0.5).filled())))?;
        }
        let circle = (0..=90).map(|n| {
            let (sin, cos) = (f64::from(n) * std::f64::consts::TAU / 90.0).sin_cos();
            (self.radius * cos, self.radius * sin)
        });
        chart.draw_series(LineSeries::new(circle, GREY.stroke_width(1)))?;
        Ok(())
    }
}
