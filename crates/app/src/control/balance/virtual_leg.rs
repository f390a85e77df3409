//! The virtual model: what hip joints must do so that a leg pushes and turns as wanted.

use crate::{kinematics::Leg, math::scalar};

/// Least determinant of a leg's Jacobian in m for which its force can be told from its joints' torques.
const LEAST_DETERMINANT_M: f32 = 1e-3;

/// What a leg does to the body, and its wheel's motor to the leg.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LegForce {
    /// Force along the leg in N, pushing hip and axle apart.
    pub push_n: f32,
    /// Torque of the body on the leg in N·m, leaning the leg forward.
    pub lean_nm: f32,
}

/// The share of the torque of its wheel, in N·m, that each hip joint of a leg must add.
///
/// The motor pushes back on one shank. With this share the leg as a whole is pushed back, as the gains assume.
pub fn reaction_nm(leg: &Leg, wheel_nm: f32) -> [f32; 2] {
    let [front_angle, rear_angle] = leg.angle_per_rad;
    let [front_carrier, rear_carrier] = leg.carrier_per_rad;
    [
        wheel_nm * (front_carrier + front_angle),
        wheel_nm * (rear_carrier + rear_angle),
    ]
}

/// Torques of the front and the rear hip joint in N·m that give this force, by the principle of virtual work.
pub fn hip_torques_nm(leg: &Leg, force: LegForce) -> [f32; 2] {
    let [front_length, rear_length] = leg.length_per_rad;
    let [front_angle, rear_angle] = leg.angle_per_rad;
    [
        front_length * force.push_n - front_angle * force.lean_nm,
        rear_length * force.push_n - rear_angle * force.lean_nm,
    ]
}

/// The force that these torques of the front and the rear hip joint give. Where the leg is stretched they say little
/// of it.
pub fn force_of(leg: &Leg, hip_nm: [f32; 2]) -> LegForce {
    let [front_length, rear_length] = leg.length_per_rad;
    let [front_angle, rear_angle] = leg.angle_per_rad;
    let [front_nm, rear_nm] = hip_nm;
    let determinant = rear_length * front_angle - front_length * rear_angle;
    let inverse = 1.0 / scalar::max(determinant, LEAST_DETERMINANT_M);
    LegForce {
        push_n: (rear_nm * front_angle - front_nm * rear_angle) * inverse,
        lean_nm: (rear_nm * front_length - front_nm * rear_length) * inverse,
    }
}

#[cfg(test)]
mod tests;
