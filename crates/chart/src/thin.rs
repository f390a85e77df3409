//! Thins out long series for a plot.

/// A series is cut into this many pieces, and each keeps two points. A plot is some 900 pixels wide.
const PIECES: usize = 450;

/// With more gaps than this, a gap no longer ends a piece.
const MOST_GAPS: usize = 200;

/// Keeps the least and the greatest value of each piece of a long series, so that no peak is lost. Gaps stay where they
/// are; in a series full of gaps, a piece with a gap in it ends with a gap.
pub fn thinned(points: &[(f64, Option<f64>)]) -> Vec<(f64, Option<f64>)> {
    if points.len() <= 2 * PIECES {
        return points.to_vec();
    }
    let size = points.len().div_ceil(PIECES);
    let gaps = points.iter().filter(|(_, value)| value.is_none()).count();
    if gaps > MOST_GAPS {
        return points.chunks(size).flat_map(extremes).collect();
    }
    let runs = points.split_inclusive(|(_, value)| value.is_none());
    runs.flat_map(|run| run.chunks(size))
        .flat_map(extremes)
        .collect()
}

fn extremes(piece: &[(f64, Option<f64>)]) -> Vec<(f64, Option<f64>)> {
    let known = || piece.iter().filter(|(_, value)| value.is_some());
    let by_value = |a: &&(f64, Option<f64>), b: &&(f64, Option<f64>)| {
        a.1.partial_cmp(&b.1).unwrap_or(std::cmp::Ordering::Equal)
    };
    let (least, greatest) = (known().min_by(by_value), known().max_by(by_value));
    let mut left: Vec<_> = [least, greatest].into_iter().flatten().copied().collect();
    left.sort_by(|a, b| a.0.total_cmp(&b.0));
    let gap = piece.iter().any(|(_, value)| value.is_none());
    left.extend(piece.last().filter(|_| gap).map(|(t, _)| (*t, None)));
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line must not be drawn across a gap, nor end early before it.
    #[test]
    fn the_points_beside_a_gap_stay() {
        let mut points: Vec<_> = (0..10_000).map(|i| (f64::from(i), Some(0.0))).collect();
        points[8_001] = (8_000.0, None);
        points[8_000].1 = Some(1.0);
        points[8_002].1 = Some(-1.0);
        let left = thinned(&points);
        let gap = left.iter().position(|(_, value)| value.is_none()).unwrap();
        assert_eq!(left[gap - 1], (8_000.0, Some(1.0)));
        assert!(left[gap + 1..].contains(&(8_002.0, Some(-1.0))));
        assert!(left[..gap].iter().all(|(t, _)| *t <= 8_000.0));
        assert!(left[gap + 1..].iter().all(|(t, _)| *t >= 8_002.0));
    }

    #[test]
    fn a_single_peak_and_a_gap_stay() {
        let mut points: Vec<_> = (0..10_000).map(|i| (f64::from(i), Some(0.0))).collect();
        points[4_321].1 = Some(7.0);
        points[1_234].1 = Some(-3.0);
        points[8_000].1 = None;
        let left = thinned(&points);
        assert!(left.len() <= 2 * PIECES + 1);
        assert!(left.contains(&(4_321.0, Some(7.0))) && left.contains(&(1_234.0, Some(-3.0))));
        assert_eq!(left.iter().filter(|(_, value)| value.is_none()).count(), 1);
        assert!(left.is_sorted_by(|a, b| a.0 <= b.0));
    }
}
