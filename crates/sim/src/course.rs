//! The ground as lines along x, for drawing.

use robot_plant::{free::Corners, world::Terrain};

/// Points (x, z) of the ground under the left and the right wheel, at least one each. The first and the last height go on
/// for ever.
pub(crate) type Profiles = [Corners; 2];

/// The ground of a course.
pub(crate) fn profiles(terrain: &Terrain) -> Profiles {
    terrain.corners().map(|corners| {
        if corners.is_empty() {
            vec![[0.0, 0.0]]
        } else {
            corners
        }
    })
}

/// Height of a profile at `x`.
pub(crate) fn height_m(profile: &[[f64; 2]], x: f64) -> f64 {
    let mut before: Option<[f64; 2]> = None;
    for point in profile {
        if x < point[0] {
            return match before {
                None => point[1],
                Some([from, z]) => z + (point[1] - z) * (x - from) / (point[0] - from),
            };
        }
        before = Some(*point);
    }
    before.map_or(0.0, |point| point[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_rises_between_its_ends_and_a_step_has_an_edge() {
        let [slope, _] = profiles(&Terrain::Slope {
            start_m: 1.0,
            angle_rad: std::f64::consts::FRAC_PI_4,
            length_m: 2.0,
        });
        let heights = [0.0, 1.5, 9.0].map(|x| height_m(&slope, x));
        for (height, wanted) in heights.iter().zip([0.0, 0.5, 2.0]) {
            assert!((height - wanted).abs() < 1e-12, "{heights:?}");
        }
        let [step, _] = profiles(&Terrain::Step {
            at_m: 1.0,
            height_m: -0.15,
        });
        assert_eq!([0.99, 1.01].map(|x| height_m(&step, x)), [0.0, -0.15]);
    }
}
