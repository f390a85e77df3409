//! Three-vectors as plain arrays.

use super::scalar;

/// A vector with the components x, y, z.
pub type Vector3 = [f32; 3];

/// a + b.
pub fn add([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ax + bx, ay + by, az + bz]
}

/// a − b.
pub fn sub([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ax - bx, ay - by, az - bz]
}

/// The vector times a factor.
pub fn scale([x, y, z]: Vector3, factor: f32) -> Vector3 {
    [x * factor, y * factor, z * factor]
}

/// Product component by component.
pub fn multiply([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ax * bx, ay * by, az * bz]
}

/// Scalar product a · b.
pub fn dot([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> f32 {
    ax * bx + ay * by + az * bz
}

/// Vector product a × b.
pub fn cross([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

/// Length of the vector.
pub fn norm(v: Vector3) -> f32 {
    scalar::sqrt(dot(v, v))
}

/// True if no component is larger than `limit` in magnitude; false for NaN.
pub fn is_within(v: Vector3, limit: f32) -> bool {
    v.iter().all(|x| x.abs() <= limit)
}
