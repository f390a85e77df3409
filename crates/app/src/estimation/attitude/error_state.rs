//! The error-state vector: which error has which index, and arithmetic on vectors of that length.
//!
//! The functions are kept out of line. Unrolled at each call they would fill the flash.

/// Number of error states.
pub(super) const STATES: usize = 17;
/// Angles about east, north and up (rad), velocity east and north (m/s), gyro bias (rad/s), gyro misalignment row by row.
pub(super) type ErrorVector = [f32; STATES];

/// Index of the angle about up.
pub(super) const HEADING: usize = 2;
/// Index of the velocity east. Velocity north follows.
pub(super) const SPEED: usize = 3;
/// Index of the gyro bias about x. The other gyro parameters follow.
pub(super) const BIAS: usize = 5;
/// Index of the first element of the misalignment matrix.
pub(super) const MISALIGNMENT: usize = 8;

/// Number of parameters of the gyro model.
pub(super) const GYRO_PARAMETERS: usize = 12;
/// Bias x, y, z (rad/s), then the misalignment row by row.
pub(super) type GyroParameters = [f32; GYRO_PARAMETERS];

/// The gyro parameters within an error vector.
pub(super) const fn gyro_parameters(errors: &ErrorVector) -> &GyroParameters {
    let [_, _, _, _, _, parameters @ ..] = errors;
    parameters
}

/// `to += factor · vector`.
#[inline(never)]
pub(super) fn add_scaled(to: &mut ErrorVector, factor: f32, vector: &ErrorVector) {
    for (to, value) in to.iter_mut().zip(vector) {
        *to += factor * value;
    }
}

/// Scalar product.
#[inline(never)]
pub(super) fn dot(a: &GyroParameters, b: &GyroParameters) -> f32 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}
