//! Measures from which sides the field came, seen from the robot.

use nalgebra::Vector3;

/// Number of directions, which are spread evenly over the sphere.
const DIRECTIONS: usize = 64;
/// Cosine of the angle around a sample in which directions count as covered: 20°.
const NEAR_COS: f64 = 0.94;

/// How much of the sphere the samples cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Share of the sphere, from 0 to 1.
    pub share: f64,
    /// The direction that is furthest from any sample, in the body frame.
    pub widest_gap: Vector3<f64>,
}

impl Coverage {
    /// Measures the coverage of corrected samples.
    pub(super) fn of(samples: &[Vector3<f64>]) -> Self {
        let seen: Vec<_> = samples.iter().map(|v| v.normalize()).collect();
        let nearest: Vec<(Vector3<f64>, f64)> = spiral()
            .map(|d| (d, seen.iter().map(|s| s.dot(&d)).fold(-1.0, f64::max)))
            .collect();
        let covered = nearest.iter().filter(|(_, cos)| *cos >= NEAR_COS).count();
        let widest = nearest.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        Self {
            share: covered as f64 / DIRECTIONS as f64,
            widest_gap: widest.map_or(Vector3::zeros(), |(direction, _)| *direction),
        }
    }

    /// Describes the gap in words such as `front left top`.
    pub fn widest_gap_words(&self) -> String {
        let names = [("front", "back"), ("left", "right"), ("top", "bottom")];
        let words: Vec<&str> = self
            .widest_gap
            .iter()
            .zip(names)
            .filter(|(part, _)| part.abs() > 0.35)
            .map(|(part, (positive, negative))| if *part > 0.0 { positive } else { negative })
            .collect();
        words.join(" ")
    }
}

/// Returns points on Fibonacci's spiral, which has equal steps of height and golden steps of longitude.
fn spiral() -> impl Iterator<Item = Vector3<f64>> {
    let golden_rad = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..DIRECTIONS).map(move |index| {
        let z = 1.0 - (2.0 * index as f64 + 1.0) / DIRECTIONS as f64;
        let (sin, cos) = (golden_rad * index as f64).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        Vector3::new(radius * cos, radius * sin, z)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_sphere_is_half_covered_and_the_rest_is_named() {
        let upper: Vec<_> = spiral().filter(|d| d.z > 0.0).collect();
        let coverage = Coverage::of(&upper);
        // 20° reach over the equator: half of the sphere and sin 20° / 2 more, less what lies between samples.
        assert!((0.5..=0.68).contains(&coverage.share), "{coverage:?}");
        assert!(coverage.widest_gap_words().contains("bottom"));
    }

    #[test]
    fn a_whole_sphere_is_covered() {
        let all: Vec<_> = spiral().map(|d| d * 48.0).collect();
        assert_eq!(Coverage::of(&all).share, 1.0);
    }
}
