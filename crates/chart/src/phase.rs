//! One quantity over another as they change together, such as a rate over its angle.

use plotters::prelude::*;

use crate::{
    BLUE, ChartError, GREEN, GREY, ORANGE,
    canvas::{self, GRID},
    label_style,
    plot::padded,
};

/// The points of a phase plot, in the order in which they were passed.
pub struct Phase<'a> {
    /// What is to the right, with its unit.
    pub x_label: &'a str,
    /// What is upward, with its unit.
    pub y_label: &'a str,
    pub points: Vec<(f64, f64)>,
}

impl Phase<'_> {
    /// Draws the line through the points as SVG text, each axis at its own scale. A green dot is the start, an orange one the
    /// end.
    pub fn draw(&self) -> Result<String, ChartError> {
        const SIDE: u32 = 520;
        let x = padded(self.points.iter().map(|point| point.0));
        let y = padded(self.points.iter().map(|point| point.1));
        canvas::svg((SIDE, SIDE), |area| {
            let mut chart = ChartBuilder::on(area)
                .margin(10)
                .x_label_area_size(40)
                .y_label_area_size(64)
                .build_cartesian_2d(x, y)?;
            chart
                .configure_mesh()
                .light_line_style(TRANSPARENT)
                .bold_line_style(GRID)
                .axis_style(GREY)
                .label_style(label_style())
                .x_desc(self.x_label)
                .y_desc(self.y_label)
                .draw()?;
            let line = self.points.iter().copied();
            chart.draw_series(LineSeries::new(line, BLUE.mix(0.7).stroke_width(1)))?;
            let ends = [(self.points.first(), GREEN), (self.points.last(), ORANGE)];
            chart
                .draw_series(ends.into_iter().filter_map(|(point, colour)| {
                    Some(Circle::new(*point?, 5, colour.filled()))
                }))?;
            Ok(())
        })
    }
}
