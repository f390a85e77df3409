//! Values as whole numbers of steps.

/// Rounds to the nearest step. The conversion saturates, and NaN becomes 0.
#[inline(never)]
pub(super) fn fixed(value: f32, steps: f32) -> i16 {
    rounded(value * steps) as i16
}

/// Does the same in one byte.
#[inline(never)]
pub(super) fn fixed_byte(value: f32, steps: f32) -> u8 {
    (rounded(value * steps) as i8).cast_unsigned()
}

/// Does the same with a value without a sign. What is below zero becomes 0.
pub(super) fn positive_byte(value: f32, steps: f32) -> u8 {
    (value * steps + 0.5) as u8
}

fn rounded(steps: f32) -> f32 {
    steps + if steps < 0.0 { -0.5 } else { 0.5 }
}
