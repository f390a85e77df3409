//! Three-vectors as plain arrays.

use super::scalar;

pub type Vector3 = [f32; 3];

pub fn add([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ax + bx, ay + by, az + bz]
}

pub fn sub([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ax - bx, ay - by, az - bz]
}

pub fn scale([x, y, z]: Vector3, factor: f32) -> Vector3 {
    [x * factor, y * factor, z * factor]
}

pub fn multiply([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ax * bx, ay * by, az * bz]
}

pub fn dot([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> f32 {
    ax * bx + ay * by + az * bz
}

pub fn cross([ax, ay, az]: Vector3, [bx, by, bz]: Vector3) -> Vector3 {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

pub fn norm(v: Vector3) -> f32 {
    scalar::sqrt(dot(v, v))
}

/// True if each component is at most `limit` in size; false for NaN.
pub fn is_within(v: Vector3, limit: f32) -> bool {
    v.iter().all(|x| x.abs() <= limit)
}
