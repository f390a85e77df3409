//! Attitudes in double precision.

mod error;

pub use error::AttitudeError;

/// Body → ENU earth, scalar first.
pub type Quaternion = [f64; 4];

/// Rotation about the earth's vertical.
pub(crate) fn from_yaw(yaw_rad: f64) -> Quaternion {
    let (sin, cos) = (yaw_rad / 2.0).sin_cos();
    [cos, 0.0, 0.0, sin]
}

/// Turned about the earth's vertical, then pitched about the body's y axis, nose down positive.
pub(crate) fn from_yaw_pitch(yaw_rad: f64, pitch_rad: f64) -> Quaternion {
    let (sin, cos) = (pitch_rad / 2.0).sin_cos();
    multiply(from_yaw(yaw_rad), [cos, 0.0, sin, 0.0])
}

/// The Hamilton product `a·b`: `b` first, then `a`.
pub fn multiply(a: Quaternion, b: Quaternion) -> Quaternion {
    let [w, x, y, z] = a;
    let [bw, bx, by, bz] = b;
    [
        w * bw - x * bx - y * by - z * bz,
        w * bx + x * bw + y * bz - z * by,
        w * by - x * bz + y * bw + z * bx,
        w * bz + x * by - y * bx + z * bw,
    ]
}

pub(crate) fn conjugate([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

/// `None` for what is not a number and for zero.
pub fn normalised(q: Quaternion) -> Option<Quaternion> {
    let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    (norm.is_finite() && norm > 0.0).then(|| q.map(|c| c / norm))
}

/// An earth vector in body axes.
pub fn to_body(q: Quaternion, earth: [f64; 3]) -> [f64; 3] {
    let [_, x, y, z] = multiply(
        conjugate(q),
        multiply([0.0, earth[0], earth[1], earth[2]], q),
    );
    [x, y, z]
}

/// Straight line between two attitudes, the short way round, put back on the sphere; `None` where one is not a number.
pub fn between(a: Quaternion, b: Quaternion, share: f64) -> Option<Quaternion> {
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    normalised(std::array::from_fn(|i| a[i] + share * (sign * b[i] - a[i])))
}

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
    fn heading_and_inclination_are_told_apart() {
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
    fn north_is_to_the_left_of_a_body_facing_east() {
        close(
            to_body(from_yaw(0.0), [0.0, 22.0, -42.0]),
            [0.0, 22.0, -42.0],
        );
        close(
            to_body(from_yaw(std::f64::consts::FRAC_PI_2), [0.0, 22.0, -42.0]),
            [22.0, 0.0, -42.0],
        );
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
