//! Geometry and motion of a five-bar leg.
//!
//! In the plane of a leg x points forward and z up from the hip centre. The hips sit at ±half of their gap. Each thigh
//! ends in a knee, and the shanks meet at the axle below. A joint's angle is that of its thigh from the horizontal
//! outward; both turn about −y. The leg's angle is positive when the axle is ahead of the hip centre.

use crate::{
    domain::{Carrier, JointFeedback, LegGeometry},
    math::scalar,
};

/// Largest angle of a thigh that counts. It lies beyond the limits of any robot.
const MAX_ANGLE_RAD: f32 = 1.6;
/// The knees' distance must lie between these multiples of twice the shank's length. Beyond, the leg cannot be closed,
/// or its Jacobian is useless.
const KNEE_RANGE: (f32, f32) = (0.1, 0.98);
/// The shortest leg that counts, in m.
const LEAST_LENGTH_M: f32 = 0.02;
/// Least sine of the angle between the shanks for which the Jacobian is exact.
const LEAST_SINE: f32 = 0.05;

/// Pose, motion and Jacobian of a leg. Pairs of joints are front, rear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Distance from hip centre to axle in m.
    pub length_m: f32,
    /// Angle of that line in the body in rad, forward positive.
    pub angle_rad: f32,
    /// Rate of the length in m/s.
    pub length_mps: f32,
    /// Rate of the angle in rad/s.
    pub angle_rps: f32,
    /// Rotation of the shank that carries the wheel's motor, in the body, about +y in rad/s.
    pub carrier_rps: f32,
    /// Derivatives of the length by the joints in m/rad.
    pub length_per_rad: [f32; 2],
    /// Derivatives of the angle by the joints.
    pub angle_per_rad: [f32; 2],
    /// Derivatives of the carrier's rotation about +y by the joints.
    pub carrier_per_rad: [f32; 2],
    /// The joints' angles fit the geometry. If not, the nearest pose that fits stands here.
    pub fits: bool,
}

impl Leg {
    /// Computes a leg from its joints' angles in rad and speeds in rad/s, front and rear. Anything that is not a
    /// number counts as zero. All results are finite.
    ///
    /// ```
    /// use robot_app::{kinematics::Leg, domain::LegGeometry};
    /// let leg = Leg::new(&LegGeometry::EXAMPLE, [0.0, 0.0], [0.0, 0.0]);
    /// // Both thighs level: the knees are 0.34 m apart, and √(0.22² − 0.17²) = 0.1396.
    /// assert!((leg.length_m - 0.139_64).abs() < 1e-5 && leg.angle_rad.abs() < 1e-6);
    /// ```
    pub fn new(geometry: &LegGeometry, angles_rad: [f32; 2], speeds_rps: [f32; 2]) -> Self {
        let [front_rad, rear_rad] = angles_rad.map(within_range);
        let [front_rps, rear_rps] = speeds_rps.map(finite);
        let half_gap_m = 0.5 * geometry.hip_gap_m;
        let thigh_m = geometry.thigh_m;
        let (front_sin, front_cos) = scalar::sin_cos(front_rad);
        let (rear_sin, rear_cos) = scalar::sin_cos(rear_rad);
        let front_knee = [half_gap_m + thigh_m * front_cos, thigh_m * front_sin];
        let rear_knee = [-half_gap_m - thigh_m * rear_cos, -thigh_m * rear_sin];
        let front_knee_per_rad = [-thigh_m * front_sin, thigh_m * front_cos];
        let rear_knee_per_rad = [thigh_m * rear_sin, -thigh_m * rear_cos];
        let (axle, closed) = axle(front_knee, rear_knee, geometry.shank_m);

        let front_shank = sub(axle, front_knee);
        let rear_shank = sub(axle, rear_knee);
        // Each shank keeps its length: its end moves along it as fast as its knee.
        let least_m2 = LEAST_SINE * geometry.shank_m * geometry.shank_m;
        let inverse = 1.0 / scalar::max(cross(front_shank, rear_shank), least_m2);
        let front_gain = dot(front_shank, front_knee_per_rad) * inverse;
        let rear_gain = dot(rear_shank, rear_knee_per_rad) * inverse;
        let axle_per_front = [rear_shank[1] * front_gain, -rear_shank[0] * front_gain];
        let axle_per_rear = [-front_shank[1] * rear_gain, front_shank[0] * rear_gain];

        let squared = dot(axle, axle);
        let inverse_length = scalar::inverse_sqrt(squared);
        let along = [axle[0] * inverse_length, axle[1] * inverse_length];
        let across = [-along[1], along[0]];
        let length_per_rad = [dot(along, axle_per_front), dot(along, axle_per_rear)];
        let angle_per_rad = [
            dot(across, axle_per_front) * inverse_length,
            dot(across, axle_per_rear) * inverse_length,
        ];
        let (carrier, ends_per_rad) = match geometry.carrier {
            Carrier::Front => (
                front_shank,
                [sub(axle_per_front, front_knee_per_rad), axle_per_rear],
            ),
            Carrier::Rear => (
                rear_shank,
                [axle_per_front, sub(axle_per_rear, rear_knee_per_rad)],
            ),
        };
        let inverse_square = 1.0 / dot(carrier, carrier);
        let carrier_per_rad = ends_per_rad.map(|end| cross(end, carrier) * inverse_square);
        let speeds = [front_rps, rear_rps];
        Self {
            length_m: squared * inverse_length,
            angle_rad: scalar::atan2(axle[0], -axle[1]),
            length_mps: dot(length_per_rad, speeds),
            angle_rps: dot(angle_per_rad, speeds),
            carrier_rps: dot(carrier_per_rad, speeds),
            length_per_rad,
            angle_per_rad,
            carrier_per_rad,
            fits: closed && [front_rad, rear_rad] == angles_rad,
        }
    }

    /// The leg whose joints report this, front and rear.
    pub fn measured(geometry: &LegGeometry, front: &JointFeedback, rear: &JointFeedback) -> Self {
        Self::new(
            geometry,
            [front.pos_rad, rear.pos_rad],
            [front.vel_rps, rear.vel_rps],
        )
    }
}

type Point = [f32; 2];

/// The lower intersection of the circles of a shank's length about both knees, and whether there is one.
fn axle(front_knee: Point, rear_knee: Point, shank_m: f32) -> (Point, bool) {
    let span = sub(front_knee, rear_knee);
    let middle = [
        0.5 * (front_knee[0] + rear_knee[0]),
        0.5 * (front_knee[1] + rear_knee[1]),
    ];
    let (low, high) = KNEE_RANGE;
    let reach = 4.0 * shank_m * shank_m;
    let squared = dot(span, span);
    let usable = scalar::clamp(squared, low * low * reach, high * high * reach);
    // From the middle the axle lies across the span.
    let factor = scalar::sqrt(0.25 * (reach / usable - 1.0));
    let point = [middle[0] + factor * span[1], middle[1] - factor * span[0]];
    let lowest = [point[0], scalar::min(point[1], -LEAST_LENGTH_M)];
    (lowest, usable == squared && lowest == point)
}

/// Limits a joint's angle to what the formulas hold for.
fn within_range(angle_rad: f32) -> f32 {
    scalar::clamp(finite(angle_rad), -MAX_ANGLE_RAD, MAX_ANGLE_RAD)
}

fn finite(value: f32) -> f32 {
    if value.is_finite() { value } else { 0.0 }
}

fn sub([ax, az]: Point, [bx, bz]: Point) -> Point {
    [ax - bx, az - bz]
}

fn dot([ax, az]: Point, [bx, bz]: Point) -> f32 {
    ax * bx + az * bz
}

fn cross([ax, az]: Point, [bx, bz]: Point) -> f32 {
    ax * bz - az * bx
}

#[cfg(test)]
mod tests;
