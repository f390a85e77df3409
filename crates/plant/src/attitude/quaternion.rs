//! Unit quaternions in double precision, scalar first.

/// Body → ENU earth, scalar first.
pub type Quaternion = [f64; 4];

/// Rotation about the earth's vertical.
fn from_yaw(yaw_rad: f64) -> Quaternion {
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

pub(super) fn conjugate([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

/// Scales to unit length. `None` for zero and for values that are not numbers.
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

/// A vector in body axes as one of the earth.
pub fn to_earth(q: Quaternion, body: [f64; 3]) -> [f64; 3] {
    to_body(conjugate(q), body)
}

/// Roll (right side down positive), pitch (nose down positive) and yaw (left positive) of the z-y-x order.
pub fn roll_pitch_yaw_rad([w, x, y, z]: Quaternion) -> [f64; 3] {
    [
        (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y)),
        (2.0 * (w * y - z * x)).clamp(-1.0, 1.0).asin(),
        (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z)),
    ]
}

/// Interpolates linearly between two attitudes, the short way round, and normalises. `None` if one is not a number.
pub fn between(a: Quaternion, b: Quaternion, share: f64) -> Option<Quaternion> {
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    normalised(std::array::from_fn(|i| a[i] + share * (sign * b[i] - a[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: [f64; 3], expected: [f64; 3]) {
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-9, "{got} against {expected}");
        }
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
}
