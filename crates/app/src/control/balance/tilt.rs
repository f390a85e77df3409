//! Attitude in the planes of the legs.

use crate::math::{Quaternion, Vector3, scalar, vector};

/// Least square of the vertical's part in the planes of the legs. Below it the robot lies on its side.
const LEAST_PLANE: f32 = 0.01;

/// Pitch and roll as angles of the vertical, which do not meet a singularity before the robot lies on its side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tilt {
    /// Angle of the body in the planes of the legs in rad, −π…π, nose down positive.
    pub pitch_rad: f32,
    /// Its rate in rad/s.
    pub pitch_rps: f32,
    /// Angle of the legs' planes from the vertical in rad, right side down positive.
    pub roll_rad: f32,
    /// Its rate in rad/s.
    pub roll_rps: f32,
    /// Rate about the vertical in rad/s, left positive.
    pub yaw_rps: f32,
    /// The vertical in body axes.
    pub up: Vector3,
}

impl Tilt {
    /// Computes the tilt from the rotation from body to world axes and the body's rate in body axes.
    pub fn new(orientation: Quaternion, rate_rps: Vector3) -> Self {
        let Quaternion { w, x, y, z } = orientation;
        let up = [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ];
        let [forward, left, above] = up;
        let [rate_x, rate_y, rate_z] = rate_rps;
        let in_plane = scalar::max(forward * forward + above * above, LEAST_PLANE);
        let across_rps = rate_x * forward + rate_z * above;
        let inverse = scalar::inverse_sqrt(in_plane);
        Self {
            pitch_rad: scalar::atan2(-forward, above),
            pitch_rps: rate_y - left * across_rps * inverse * inverse,
            roll_rad: scalar::asin(left),
            roll_rps: (rate_x * above - rate_z * forward) * inverse,
            yaw_rps: vector::dot(rate_rps, up),
            up,
        }
    }
}

#[cfg(test)]
mod tests;
