//! Single-precision arithmetic that `core` lacks: the `libm` crate computes in double precision, which this
//! processor has no hardware for.

pub mod checksum;
pub mod quaternion;
pub mod scalar;
#[cfg(test)]
pub mod testing;
pub mod vector;

pub use quaternion::Quaternion;
pub use vector::Vector3;
