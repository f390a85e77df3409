//! Three-by-three matrices as rows.

use super::vector::{self, Vector3};

pub type Matrix3 = [Vector3; 3];

pub const fn transposed([[a, b, c], [d, e, f], [g, h, i]]: Matrix3) -> Matrix3 {
    [[a, d, g], [b, e, h], [c, f, i]]
}

/// `a` + `factor` · `b`.
#[inline(never)]
pub fn add_scaled(a: &Matrix3, factor: f32, b: &Matrix3) -> Matrix3 {
    let mut sum = *a;
    for (to, row) in sum.iter_mut().zip(b) {
        *to = vector::add(*to, vector::scale(*row, factor));
    }
    sum
}

#[cfg(test)]
mod tests;
