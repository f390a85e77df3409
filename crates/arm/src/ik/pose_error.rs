//! How far a pose is from another one, and how that changes.

use nalgebra::{Matrix3, Vector3, Vector6};

use crate::kinematics::Frame;

/// What takes a pose to its target, along the world's axes: a length in m, and the rotation as axis times angle in rad, the
/// angle between 0 and π.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseError {
    translation: Vector3<f64>,
    rotation: Vector3<f64>,
}

impl PoseError {
    #[inline]
    pub(super) fn between(current: &Frame, target: &Frame) -> Self {
        Self {
            translation: target.translation - current.translation,
            rotation: rotation_vector(&(target.rotation * current.rotation.transpose())),
        }
    }

    /// Its six parts: x, y, z, rx, ry, rz.
    #[inline]
    pub(super) fn all(&self) -> Vector6<f64> {
        let (t, r) = (self.translation, self.rotation);
        Vector6::new(t.x, t.y, t.z, r.x, r.y, r.z)
    }

    /// How the rotation part changes when the current pose turns around the world's axes: the inverse of the right Jacobian of
    /// SO(3), for `log(R exp(−δ)) ≈ log R − J δ`.
    ///
    /// It is close to 1 near the target. Where the mask leaves an axis free, the rest of the rotation stays large, and without
    /// this factor the last digits would take many iterations.
    #[inline]
    pub(super) fn turning(&self) -> Matrix3<f64> {
        let squared = self.rotation.norm_squared();
        let cross = self.rotation.cross_matrix();
        Matrix3::identity() + cross * 0.5 + cross * cross * bend(squared)
    }
}

/// `(1 − θ/2 · cot θ/2) / θ²`.
#[inline]
fn bend(angle_squared: f64) -> f64 {
    if angle_squared < 1e-4 {
        // The next term of the series is θ⁴ / 30240.
        return 1.0 / 12.0 + angle_squared / 720.0;
    }
    let angle = angle_squared.sqrt();
    let half = angle / 2.0;
    (1.0 - half / half.tan()) / angle_squared
}

/// Axis times angle of a rotation matrix.
#[inline]
fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let r = |row, column| rotation[(row, column)];
    // 2 sin θ times the axis, and 2 cos θ.
    let skew = Vector3::new(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    let sin = skew.norm();
    let cos = rotation.trace() - 1.0;
    if sin > 1e-6 {
        return skew * (sin.atan2(cos) / sin);
    }
    if cos > 0.0 {
        return skew * 0.5;
    }
    half_turn(rotation, &skew)
}

/// For an angle within 1e-6 of π, where the skew part says little about the axis: `R + 1 = 2 a aᵀ`.
#[cold]
fn half_turn(rotation: &Matrix3<f64>, skew: &Vector3<f64>) -> Vector3<f64> {
    let doubled = rotation + Matrix3::identity();
    let longest = doubled.diagonal().imax();
    let column = doubled.column(longest);
    let axis = column / column.norm().max(f64::MIN_POSITIVE);
    let angle = std::f64::consts::PI - skew.norm() / 2.0;
    let sign = if axis.dot(skew) < 0.0 { -1.0 } else { 1.0 };
    axis * (sign * angle)
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;
    use serde_json::Value;

    use super::*;

    fn frame(rows: &Value) -> Frame {
        let at = |row: usize, column: usize| rows[row][column].as_f64().expect("a number");
        Frame {
            rotation: Matrix3::from_fn(at),
            translation: Vector3::from_fn(|row, _| at(row, 3)),
        }
    }

    #[test]
    fn errors_are_those_of_roboticstoolbox() {
        let text = include_str!("../../tests/data/roboticstoolbox.json");
        let values: Value = serde_json::from_str(text).expect("JSON");
        let answers = values["errors"].as_array().expect("some");
        assert_eq!(answers.len(), 9);
        for answer in answers {
            let (current, target) = (frame(&answer["current"]), frame(&answer["target"]));
            let ours = PoseError::between(&current, &target).all();
            let theirs = answer["error"].as_array().expect("six");
            let theirs =
                Vector6::from_iterator(theirs.iter().map(|it| it.as_f64().expect("a number")));
            let mut difference = (ours - theirs).amax();
            let angle = theirs.fixed_rows::<3>(3).norm();
            if angle > std::f64::consts::PI - 1e-6 {
                // A half turn has two axes.
                let mut turned = theirs;
                turned.fixed_rows_mut::<3>(3).neg_mut();
                difference = difference.min((ours - turned).amax());
            }
            assert!(difference < 1e-8, "{ours} and {theirs}");
        }
    }

    #[test]
    fn the_rotation_part_changes_as_it_says() {
        let turns = [
            [0.0, 0.0, 1e-5],
            [0.02, -0.3, 0.1],
            [1.0, 2.0, -1.5],
            [0.1, -3.0, 0.5],
        ];
        for turn in turns {
            let current = Rotation3::new(Vector3::new(0.3, -0.8, 1.1));
            let target = Rotation3::new(Vector3::from(turn)) * current;
            let at = |rotation: Rotation3<f64>| {
                let frame = |rotation: Rotation3<f64>| Frame {
                    rotation: rotation.into_inner(),
                    translation: Vector3::zeros(),
                };
                PoseError::between(&frame(rotation), &frame(target))
            };
            let turning = at(current).turning();
            for axis in 0..3 {
                let mut small = Vector3::zeros();
                small[axis] = 1e-5;
                let ahead = at(Rotation3::new(small) * current).rotation;
                let behind = at(Rotation3::new(-small) * current).rotation;
                let measured = (behind - ahead) / 2e-5;
                let difference = (measured - turning.column(axis)).amax();
                assert!(difference < 1e-6, "{turn:?}: {measured} and {turning}");
            }
        }
    }
}
