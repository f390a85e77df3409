//! Attitudes in double precision, and the error between two of them.

mod error;
mod quaternion;

pub use error::AttitudeError;
pub(crate) use quaternion::from_yaw_pitch;
pub use quaternion::{
    Quaternion, between, multiply, normalised, roll_pitch_yaw_rad, to_body, to_earth,
};

/// Total, heading and inclination error in degrees, none negative; `None` where one is not a number.
pub(crate) fn error_deg(estimate: Quaternion, reference: Quaternion) -> Option<[f64; 3]> {
    let error = AttitudeError::between(normalised(estimate)?, normalised(reference)?);
    Some([
        error.total_deg(),
        error.heading_deg().abs(),
        error.inclination_deg(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(axis: usize, degrees: f64) -> Quaternion {
        let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
        let mut q = [cos, 0.0, 0.0, 0.0];
        q[axis + 1] = sin;
        q
    }

    fn close(got: [f64; 3], expected: [f64; 3]) {
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-9, "{got} against {expected}");
        }
    }

    #[test]
    fn heading_and_inclination_are_separate() {
        let reference = about(2, 70.0);
        close(
            error_deg(about(2, 73.0), reference).unwrap_or_default(),
            [3.0, 3.0, 0.0],
        );
        let tilted = multiply(about(0, 5.0), reference);
        close(
            error_deg(tilted, reference).unwrap_or_default(),
            [5.0, 0.0, 5.0],
        );
        // The other sign is the same attitude.
        close(
            error_deg(reference.map(|c| -c), reference).unwrap_or_default(),
            [0.0; 3],
        );
    }

    #[test]
    fn no_error_without_a_reference() {
        assert!(error_deg([1.0, 0.0, 0.0, 0.0], [f64::NAN; 4]).is_none());
        assert!(error_deg([0.0; 4], [1.0, 0.0, 0.0, 0.0]).is_none());
    }

    #[test]
    fn interpolation_goes_the_short_way() {
        let half = between(about(1, 10.0), about(1, 30.0).map(|c| -c), 0.5).unwrap_or_default();
        close(
            error_deg(half, about(1, 20.0)).unwrap_or_default(),
            [0.0; 3],
        );
    }
}
