//! Questions that have no answer.

use crate::kinematics::KinematicsError;

/// A question that does not fit the arm, or is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IkError {
    /// Joint values or a pose do not fit the arm, or are not finite.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// The mask holds a negative or infinite weight, NaN, or nothing but zeros.
    #[error(
        "mask {0:?}: its weights [x, y, z, rx, ry, rz] are finite, none is negative, and at least one is above 0"
    )]
    Mask([f64; 6]),
    /// The mask has not six weights.
    #[error("the mask has {0} weights, and 6 are needed: [x, y, z, rx, ry, rz]")]
    MaskLength(usize),
    /// A 4 × 4 matrix is no pose.
    #[error("the target is no pose: {0}")]
    NoPose(&'static str),
    /// The greatest change of a joint is not positive and finite.
    #[error("the greatest change of a joint is {0}, and must be finite and above 0")]
    Change(f64),
}
