//! The course of a signal over a run.

use std::ops::Range;

/// Instants in s, each with the value that holds from then on.
pub type Points = [(f64, Option<f64>)];

/// The increase of a count since the previous point.
pub fn rises(counts: &Points) -> Vec<(f64, Option<f64>)> {
    let pairs = counts.windows(2);
    let rise = |pair: &[(f64, Option<f64>)]| Some(pair[1].1? - pair[0].1?);
    pairs.map(|pair| (pair[1].0, rise(pair))).collect()
}

/// The spans of time in which a signal is not 0.
pub fn spans(points: &Points) -> Vec<Range<f64>> {
    let mut spans: Vec<Range<f64>> = Vec::new();
    let mut open = false;
    for (t_s, value) in points {
        let on = value.is_some_and(|value| value != 0.0);
        match spans.last_mut() {
            Some(span) if on && open => span.end = *t_s,
            _ if on => spans.push(*t_s..*t_s),
            _ => {}
        }
        open = on;
    }
    spans
}

/// The whole numbers that a signal takes, in ascending order.
pub fn distinct(points: &Points) -> Vec<u64> {
    let values = points.iter().filter_map(|p| p.1);
    let whole: std::collections::BTreeSet<u64> = values.map(|v| v as u64).collect();
    whole.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_lasts_from_the_first_to_the_last_point_that_is_on() {
        let values = [Some(0.0), Some(1.0), Some(1.0), None, Some(1.0), Some(0.0)];
        let points: Vec<_> = (0..6).map(f64::from).zip(values).collect();
        assert_eq!(spans(&points), [1.0..2.0, 4.0..4.0]);
        assert_eq!(spans(&points[..1]), []);
    }
}
