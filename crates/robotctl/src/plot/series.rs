//! Curves over time with their gaps.

use std::ops::Range;

use robot_chart::{
    BLUE, ChartError, Colour, Curve, Figure, GREEN, ORANGE, PURPLE, TimePlot, thinned,
};

/// Height of a plot in pixels.
const HEIGHT: u32 = 220;
/// Colours of the curves of one plot.
pub(super) const COLOURS: [Colour; 4] = [BLUE, ORANGE, GREEN, PURPLE];

pub(super) type Points = Vec<(f64, Option<f64>)>;

/// The time axis of a page.
pub(super) struct Axis {
    pub time: Range<f64>,
    /// Times without data.
    pub gaps: Vec<Range<f64>>,
    /// Times at which the robot was armed or disarmed, or its mode changed.
    pub marks: Vec<f64>,
}

/// The words of one plot.
pub(super) struct Words<'a> {
    pub title: &'a str,
    pub caption: &'a str,
    pub unit: &'a str,
}

impl Axis {
    /// Returns the plot of named curves, or `None` if none of them has a value.
    pub fn figure(
        &self,
        words: &Words<'_>,
        curves: Vec<(String, Points)>,
    ) -> Result<Option<Figure>, ChartError> {
        let colours = COLOURS.iter().cycle();
        let curves = curves
            .into_iter()
            .zip(colours)
            .map(|((label, points), colour)| Curve {
                label,
                colour: *colour,
                faint: false,
                points: thinned(&points),
            });
        let plot = TimePlot {
            unit: words.unit,
            height: HEIGHT,
            time: self.time.clone(),
            marks: &self.marks,
            shaded: &self.gaps,
            curves: curves.collect(),
        };
        Ok(plot.draw()?.map(|svg| Figure {
            title: words.title.to_owned(),
            caption: words.caption.to_owned(),
            legend: plot.legend(),
            svg,
        }))
    }
}

/// Returns the spans between neighbours that are more than `longest_s` apart.
pub(super) fn gaps(times: impl Iterator<Item = f64>, longest_s: f64) -> Vec<Range<f64>> {
    let mut gaps = Vec::new();
    let mut last = None;
    for t in times {
        if let Some(last) = last.filter(|last| t - last > longest_s) {
            gaps.push(last..t);
        }
        last = Some(t);
    }
    gaps
}

/// Interrupts a curve wherever neighbours are more than `longest_s` apart.
pub(super) fn with_gaps(
    points: impl Iterator<Item = (f64, Option<f64>)>,
    longest_s: f64,
) -> Points {
    let mut all: Points = Vec::new();
    for (t, value) in points {
        if let Some((last, _)) = all.last().filter(|(last, _)| t - last > longest_s) {
            all.push((*last, None));
        }
        all.push((t, value));
    }
    all
}

/// Interrupts a curve of an angle in degrees where it goes on at its other end.
pub(super) fn without_wraps(points: Points) -> Points {
    let mut all: Points = Vec::new();
    for (t, value) in points {
        let before = all.last().and_then(|(_, value)| *value);
        if let (Some(before), Some(now)) = (before, value)
            && (now - before).abs() > 180.0
        {
            all.push((t, None));
        }
        all.push((t, value));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_interrupts_curves_and_is_listed() {
        let times = [0.0, 1.0, 5.0, 6.0];
        assert_eq!(gaps(times.into_iter(), 2.0), [1.0..5.0]);
        let points = with_gaps(times.into_iter().map(|t| (t, Some(t))), 2.0);
        assert_eq!(points[2], (1.0, None));
        assert_eq!(points.len(), 5);
    }

    #[test]
    fn a_wrap_draws_no_line_across_the_plot() {
        let turning = vec![(0.0, Some(179.0)), (1.0, Some(-179.0)), (2.0, Some(-178.0))];
        let points = without_wraps(turning);
        assert_eq!(points[1], (1.0, None));
        assert_eq!(points.len(), 4);
    }
}
