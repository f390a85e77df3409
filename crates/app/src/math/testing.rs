//! Between the double precision of tests and the single precision of what they test.

use robot_test_support::Rotation;

use super::Quaternion;

/// Rounds each element.
pub fn to_f32<const N: usize>(v: [f64; N]) -> [f32; N] {
    v.map(|x| x as f32)
}

/// The rotation of a quaternion of about unit length.
pub fn rotation_of(attitude: Quaternion) -> Rotation {
    Rotation::from_wxyz(attitude.to_wxyz().map(f64::from))
}
