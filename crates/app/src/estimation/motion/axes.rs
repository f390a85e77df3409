//! The directions in which a wheeled robot can and cannot move.

use super::BodyPose;
use crate::math::{Vector3, scalar, vector};

/// Cosine of the tilt up to which the wheels are taken to touch the ground.
const MIN_UPRIGHT: f32 = 0.5;

/// The body's axes, level ones that share its heading (forward, left, up), and how they turn.
#[derive(Debug)]
pub(super) struct Axes {
    /// Body → world.
    rotation: [Vector3; 3],
    /// The body's x axis laid flat, east and north.
    forward: [f32; 2],
    yaw_rps: f32,
    pitch_rps: f32,
}

impl Axes {
    pub fn new(pose: &BodyPose) -> Self {
        let rotation = pose.orientation.rotation_matrix();
        let [[x, ..], [y, ..], up_in_body] = rotation;
        let [_, pitch_rps, _] = pose.rate_rps;
        // Zero when the robot stands on its nose: then it has no forward.
        let inverse = scalar::inverse_sqrt(x * x + y * y);
        Self {
            rotation,
            forward: [x * inverse, y * inverse],
            yaw_rps: vector::dot(up_in_body, pose.rate_rps),
            pitch_rps,
        }
    }

    /// Rate about the vertical.
    pub const fn yaw_rps(&self) -> f32 {
        self.yaw_rps
    }

    /// Rate about the axle.
    pub const fn pitch_rps(&self) -> f32 {
        self.pitch_rps
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

    /// The part of a body vector along the level forward axis.
    pub fn forward(&self, body: Vector3) -> f32 {
        let [east, north, _] = self.rotation;
        let [fx, fy] = self.forward;
        fx * vector::dot(east, body) + fy * vector::dot(north, body)
    }

    /// World → forward, left, up.
    pub fn flat(&self, [x, y, z]: Vector3) -> Vector3 {
        let [fx, fy] = self.forward;
        [fx * x + fy * y, fx * y - fy * x, z]
    }

    /// Forward, left, up → world.
    pub fn flat_to_world(&self, [forward, left, up]: Vector3) -> Vector3 {
        let [fx, fy] = self.forward;
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
