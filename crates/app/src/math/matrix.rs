//! Three-by-three matrices as rows.

use super::vector::{self, Vector3};

pub type Matrix3 = [Vector3; 3];

pub const fn transposed([[a, b, c], [d, e, f], [g, h, i]]: Matrix3) -> Matrix3 {
    [[a, d, g], [b, e, h], [c, f, i]]
}

/// `a` + `factor` · `b`.
pub fn add_scaled([ax, ay, az]: Matrix3, factor: f32, [bx, by, bz]: Matrix3) -> Matrix3 {
    let sum = |a, b| vector::add(a, vector::scale(b, factor));
    [sum(ax, bx), sum(ay, by), sum(az, bz)]
}
