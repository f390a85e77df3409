//! Lines over the leg length.

use plotters::prelude::*;
use robot_chart::{ChartError, Colour, GREY, WIDTH, draw_svg, label_style};

const HEIGHT: u32 = 260;

/// A line: its colour and its points, length in m and value.
pub struct Line {
    pub colour: Colour,
    pub points: Vec<(f64, f64)>,
}

/// Draws the lines from zero to a little above the highest.
pub fn draw(lines: &[Line], unit: &str) -> Result<String, ChartError> {
    let points = || lines.iter().flat_map(|line| &line.points);
    let lengths = points().map(|point| point.0);
    let (low, high) = lengths.fold((f64::INFINITY, 0.0_f64), |(low, high), length_m| {
        (low.min(length_m), high.max(length_m))
    });
    let top = 1.1 * points().map(|point| point.1).fold(1e-3, f64::max);
    draw_svg((WIDTH, HEIGHT), |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(26)
            .y_label_area_size(72)
            .build_cartesian_2d(low..high, 0.0..top)?;
        chart
            .configure_mesh()
            .axis_style(GREY)
            .label_style(label_style())
            .bold_line_style(GREY.mix(0.2))
            .light_line_style(TRANSPARENT)
            .y_desc(unit)
            .x_label_formatter(&|length_m| format!("{length_m:.2} m"))
            .draw()?;
        for line in lines {
            let style = line.colour.stroke_width(2);
            chart.draw_series(LineSeries::new(line.points.iter().copied(), style))?;
        }
        Ok(())
    })
}
