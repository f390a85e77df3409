//! The position: a compensated sum of small steps.

use crate::math::Vector3;

/// Sums up steps of a fraction of a millimetre for hours.
///
/// The rounding error of each addition is carried along (W. Kahan, "Further remarks on reducing truncation errors",
/// 1965). Beyond 100 m a plain sum would lose up to 4 µm in each of a thousand steps a second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Position {
    total_m: Vector3,
    /// Part of the steps that rounding has added to the total beyond their sum.
    excess_m: Vector3,
}

impl Position {
    pub const fn new() -> Self {
        Self {
            total_m: [0.0; 3],
            excess_m: [0.0; 3],
        }
    }

    /// Adds a step in the world frame.
    pub fn add(&mut self, step_m: Vector3) {
        let sums = self.total_m.iter_mut().zip(&mut self.excess_m);
        for ((total_m, excess_m), step_m) in sums.zip(step_m) {
            let wanted_m = step_m - *excess_m;
            let sum_m = *total_m + wanted_m;
            *excess_m = (sum_m - *total_m) - wanted_m;
            *total_m = sum_m;
        }
    }

    /// The position in the world frame.
    pub const fn total_m(&self) -> Vector3 {
        self.total_m
    }
}
