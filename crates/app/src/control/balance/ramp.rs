//! A value that follows a wish smoothly.

use crate::math::scalar;

/// How fast the value closes the last bit, in 1/s.
const CLOSING_PER_S: f32 = 8.0;

/// A value and its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ramp {
    pub value: f32,
    pub rate: f32,
}

impl Ramp {
    pub const fn at(value: f32) -> Self {
        Self { value, rate: 0.0 }
    }

    /// Moves towards `target` at no more than `most_per_s`.
    pub fn step(&mut self, target: f32, most_per_s: f32, dt_s: f32) {
        self.rate = scalar::clamp(
            (target - self.value) * CLOSING_PER_S,
            -most_per_s,
            most_per_s,
        );
        self.value += self.rate * dt_s;
    }
}
