//! What the tests of the estimator's parts measure against: rotations in double precision, and random numbers.

pub mod random;
pub mod rotation;

pub use random::Random;
pub use rotation::Rotation;

pub fn to_f32<const N: usize>(v: [f64; N]) -> [f32; N] {
    v.map(|x| x as f32)
}
