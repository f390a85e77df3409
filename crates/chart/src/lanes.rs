//! Switches, states and flags over time. Each has a lane, which is filled while it is on.

use std::ops::Range;

use crate::{
    ChartError, GREY, WIDTH,
    canvas::{seconds, svg as draw_svg},
    label_style,
};
use plotters::prelude::*;

/// When one thing was on.
pub struct Lane {
    pub label: String,
    pub colour: RGBColor,
    /// Start and end of each time it was on, in seconds.
    pub on: Vec<(f64, f64)>,
}

impl Lane {
    /// A lane that is on while `is_on` holds for the value.
    pub fn new(
        label: impl Into<String>,
        colour: RGBColor,
        points: &[(f64, Option<f64>)],
        is_on: impl Fn(f64) -> bool,
    ) -> Self {
        let mut on: Vec<(f64, f64)> = Vec::new();
        let mut open = false;
        for (t, value) in points {
            let now_on = value.is_some_and(&is_on);
            match (open, now_on, on.last_mut()) {
                (true, _, Some(span)) => span.1 = *t,
                (false, true, _) => on.push((*t, *t)),
                _ => {}
            }
            open = now_on;
        }
        Self {
            label: label.into(),
            colour,
            on,
        }
    }
}

/// Draws one lane below the other as SVG text, with a line at each mark.
pub fn draw_lanes(lanes: &[Lane], time: Range<f64>, marks: &[f64]) -> Result<String, ChartError> {
    let count = lanes.len() as i32;
    let height = 48 + 26 * lanes.len() as u32;
    draw_svg((WIDTH, height), |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(26)
            .y_label_area_size(150)
            .build_cartesian_2d(time.clone(), (0..count - 1).into_segmented())?;
        let name = |at: &SegmentValue<i32>| match at {
            SegmentValue::CenterOf(i) => lanes
                .iter()
                .rev()
                .nth(usize::try_from(*i).unwrap_or(usize::MAX))
                .map_or(String::new(), |lane| lane.label.clone()),
            _ => String::new(),
        };
        chart
            .configure_mesh()
            .disable_mesh()
            .axis_style(GREY)
            .label_style(label_style())
            .x_labels(12)
            .x_label_formatter(&seconds)
            .y_labels(lanes.len())
            .y_label_formatter(&name)
            .draw()?;
        for (row, lane) in lanes.iter().rev().enumerate() {
            let row = row as i32;
            let bars = lane.on.iter().map(|(from, to)| {
                let corners = [
                    (*from, SegmentValue::Exact(row)),
                    (*to, SegmentValue::Exact(row + 1)),
                ];
                let mut bar = Rectangle::new(corners, lane.colour.mix(0.75).filled());
                bar.set_margin(4, 4, 0, 0);
                bar
            });
            chart.draw_series(bars)?;
        }
        for mark in marks {
            let line = [
                (*mark, SegmentValue::Exact(0)),
                (*mark, SegmentValue::Exact(count)),
            ];
            chart.draw_series(LineSeries::new(line, GREY.mix(0.35)))?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_is_on_from_its_first_to_just_past_its_last_true_sample() {
        let points: Vec<_> = [0.0, 1.0, 1.0, 0.0, 1.0]
            .iter()
            .enumerate()
            .map(|(i, v)| (i as f64, Some(*v)))
            .collect();
        let lane = Lane::new("x", crate::BLUE, &points, |v| v != 0.0);
        assert_eq!(lane.on, [(1.0, 3.0), (4.0, 4.0)]);
    }
}
