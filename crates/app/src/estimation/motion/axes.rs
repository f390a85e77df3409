//! Transformations between body, level and world axes.

use super::axle::AxlePath;
use crate::math::{Quaternion, Vector3, scalar, vector};

/// Attitude and angular rate of the body.
#[derive(Clone, Copy, Debug)]
pub(in crate::estimation) struct BodyPose {
    /// Body → ENU.
    pub orientation: Quaternion,
    /// Body axes, without gyro bias.
    pub rate_rps: Vector3,
}

/// Cosine of the largest tilt at which the wheels count as touching the ground.
const MIN_UPRIGHT: f32 = 0.5;

/// The body's attitude and angular rate, and the level axes forward, left and up that share its heading.
#[derive(Clone, Debug)]
pub(super) struct Axes {
    /// Body → world, by rows.
    rotation: [Vector3; 3],
    /// Unit vector of the level forward axis, east and north.
    forward: [f32; 2],
    rate_rps: Vector3,
    yaw_rps: f32,
}

impl Axes {
    /// The axes of a body in this pose.
    pub fn new(pose: &BodyPose) -> Self {
        let rotation = pose.orientation.rotation_matrix();
        let [[x, ..], [y, ..], up_in_body] = rotation;
        // Zero when the robot stands on its nose: then there is no forward axis.
        let inverse = scalar::inverse_sqrt(x * x + y * y);
        Self {
            rotation,
            forward: [x * inverse, y * inverse],
            rate_rps: pose.rate_rps,
            yaw_rps: vector::dot(up_in_body, pose.rate_rps),
        }
    }

    /// Angular rate about the vertical.
    pub const fn yaw_rps(&self) -> f32 {
        self.yaw_rps
    }

    /// Angular rate about the axle.
    pub const fn pitch_rps(&self) -> f32 {
        let [_, pitch_rps, _] = self.rate_rps;
        pitch_rps
    }

    /// Velocity relative to the axle of the point to which this way leads: forward, left and up.
    pub fn over_axle(&self, path: &AxlePath) -> Vector3 {
        self.to_level(self.to_world(path.velocity(self.rate_rps)))
    }

    /// Forward part of [`Self::over_axle`].
    pub fn forward_over_axle(&self, path: &AxlePath) -> f32 {
        self.forward(path.velocity(self.rate_rps))
    }

    /// The world's up axis in body axes.
    pub const fn up_in_body(&self) -> Vector3 {
        let [_, _, up] = self.rotation;
        up
    }

    /// True up to a tilt of 60°.
    pub const fn is_upright(&self) -> bool {
        let [_, _, [_, _, up]] = self.rotation;
        up >= MIN_UPRIGHT
    }

    /// Body → world.
    pub fn to_world(&self, body: Vector3) -> Vector3 {
        self.rotation.map(|row| vector::dot(row, body))
    }

    /// The component of a body vector along the level forward axis.
    pub fn forward(&self, body: Vector3) -> f32 {
        let [east, north, _] = self.rotation;
        let [fx, fy] = self.forward;
        fx * vector::dot(east, body) + fy * vector::dot(north, body)
    }

    /// World → forward, left, up.
    pub fn to_level(&self, [x, y, z]: Vector3) -> Vector3 {
        let [fx, fy] = self.forward;
        [fx * x + fy * y, fx * y - fy * x, z]
    }

    /// Forward, left, up → world.
    pub fn level_to_world(&self, [forward, left, up]: Vector3) -> Vector3 {
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
