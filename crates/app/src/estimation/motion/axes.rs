//! The directions in which a wheeled robot can and cannot move.

use crate::math::{Quaternion, Vector3, scalar, vector};

/// Cosine of the tilt up to which the wheels are taken to touch the ground.
const MIN_UPRIGHT: f32 = 0.5;

/// The body's axes, and level ones that share its heading: forward, left, up.
#[derive(Debug)]
pub(super) struct Axes {
    /// Body → world.
    rotation: [Vector3; 3],
    forward: Vector3,
}

impl Axes {
    pub fn new(orientation: Quaternion) -> Self {
        let rotation = orientation.rotation_matrix();
        let [[x, ..], [y, ..], _] = rotation;
        // Zero when the robot stands on its nose: then it has no forward.
        let inverse = scalar::inverse_sqrt(x * x + y * y);
        Self {
            rotation,
            forward: [x * inverse, y * inverse, 0.0],
        }
    }

    /// The body's x axis laid flat, in the world frame.
    pub const fn forward(&self) -> Vector3 {
        self.forward
    }

    /// Up in body axes.
    pub const fn up_in_body(&self) -> Vector3 {
        let [_, _, up] = self.rotation;
        up
    }

    pub const fn upright(&self) -> bool {
        let [_, _, [_, _, up]] = self.rotation;
        up >= MIN_UPRIGHT
    }

    pub fn to_world(&self, body: Vector3) -> Vector3 {
        self.rotation.map(|row| vector::dot(row, body))
    }

    /// World → forward, left, up.
    pub fn flat(&self, [x, y, z]: Vector3) -> Vector3 {
        let [fx, fy, _] = self.forward;
        [fx * x + fy * y, fx * y - fy * x, z]
    }

    /// Forward, left, up → world.
    pub fn flat_to_world(&self, [forward, left, up]: Vector3) -> Vector3 {
        let [fx, fy, _] = self.forward;
        [fx * forward - fy * left, fy * forward + fx * left, up]
    }

    /// World → body.
    pub fn to_body(&self, [x, y, z]: Vector3) -> Vector3 {
        let [rx, ry, rz] = self.rotation;
        vector::add(
            vector::scale(rx, x),
            vector::add(vector::scale(ry, y), vector::scale(rz, z)),
        )
    }
}
