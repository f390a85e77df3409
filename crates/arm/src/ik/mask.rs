//! Which parts of a pose count.

use super::IkError;

/// Weights of the six parts of a pose's error: x, y, z in m, and the rotation as axis times angle in rad, all along the world's
/// axes. A part of weight 0 may come out as it likes; of the others, a heavier one comes closer where not all can be had.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mask([f64; 6]);

impl Mask {
    /// Place and orientation.
    pub const POSE: Self = Self([1.0; 6]);
    /// The place alone.
    pub const POSITION: Self = Self([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    /// The place, and the orientation but for a turn around the vertical: what an arm of five joints can do whose first joint is
    /// vertical.
    pub const WITHOUT_YAW: Self = Self([1.0, 1.0, 1.0, 1.0, 1.0, 0.0]);

    /// A mask of weights `[x, y, z, rx, ry, rz]`.
    ///
    /// # Errors
    /// A weight is negative, NaN or infinite, or all are 0.
    pub fn new(weights: [f64; 6]) -> Result<Self, IkError> {
        let are_weights = weights.iter().all(|it| it.is_finite() && *it >= 0.0);
        if are_weights && weights.iter().any(|it| *it > 0.0) {
            return Ok(Self(weights));
        }
        Err(IkError::Mask(weights))
    }

    /// The weights.
    pub fn weights(self) -> [f64; 6] {
        self.0
    }

    /// Parts that count.
    pub(super) fn axes(self) -> usize {
        self.0.iter().filter(|it| **it > 0.0).count()
    }
}

impl TryFrom<&[f64]> for Mask {
    type Error = IkError;

    fn try_from(weights: &[f64]) -> Result<Self, IkError> {
        match weights.try_into() {
            Ok(weights) => Self::new(weights),
            Err(_) => Err(IkError::MaskLength(weights.len())),
        }
    }
}
