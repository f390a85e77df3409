//! Knees push the robot off the edge or the face on which it lies: the thighs of that side swing down beside the body.

use super::{
    law::Torques,
    measured::{Measured, Thigh},
    virtual_leg::reaction_nm,
};
use crate::{domain::BalanceLimits, math::scalar};

/// Up to this pitch in rad the thighs push as on an edge, beyond it as on a face. It is less than that of a robot that lies on its
/// face, which keeps its goals until its knees have lifted it so far.
const EDGE_UP_TO_RAD: f32 = 1.0;
/// Angles above the level in rad to which the thighs of the lower and of the other side are turned, on an edge and on a
/// face. On an edge the other thighs keep the legs short, so that the wheels do not lift the wrong end.
const ON_EDGE_RAD: [f32; 2] = [-0.4, 0.75];
const ON_FACE_RAD: [f32; 2] = [-0.15, 0.22];
/// The thighs of the lower side have arrived when they are this close to it, in rad.
const CLOSE_RAD: f32 = 0.1;
/// Stiffness and damping in N·m/rad and N·m·s/rad.
const NM_PER_RAD: f32 = 200.0;
const NMS_PER_RAD: f32 = 0.5;

/// Torques that swing the thighs while each wheel gets `wheel_nm`.
pub fn push(limits: &BalanceLimits, measured: &Measured, wheel_nm: f32) -> Torques {
    let [lower_rad, other_rad] = goal_rad(measured);
    let (front_rad, rear_rad) = if lies_on_front(measured) {
        (lower_rad, other_rad)
    } else {
        (other_rad, lower_rad)
    };
    let limited = |nm: f32| scalar::clamp(nm, -limits.hip_nm, limits.hip_nm);
    let [left, right] = &measured.thighs;
    let [left_leg, right_leg] = &measured.legs;
    let hips_nm = [(left, left_leg), (right, right_leg)].map(|(thighs, leg)| {
        let [front_nm, rear_nm] = reaction_nm(leg, wheel_nm);
        let [front, rear] = thighs;
        // A rear thigh goes up as its joint's angle falls.
        [
            limited(torque_nm(front, front_rad) + front_nm),
            limited(rear_nm - torque_nm(rear, rear_rad)),
        ]
    });
    Torques {
        wheels_nm: [wheel_nm; 2],
        hips_nm,
    }
}

/// Whether the thighs of the lower side have swung down.
pub fn are_down(measured: &Measured) -> bool {
    let on_front = lies_on_front(measured);
    let [lower_rad, _] = goal_rad(measured);
    measured.thighs.iter().all(|[front, rear]| {
        let thigh = if on_front { front } else { rear };
        thigh.rad < lower_rad + CLOSE_RAD
    })
}

fn goal_rad(measured: &Measured) -> [f32; 2] {
    if measured.tilt.pitch_rad.abs() < EDGE_UP_TO_RAD {
        ON_EDGE_RAD
    } else {
        ON_FACE_RAD
    }
}

fn lies_on_front(measured: &Measured) -> bool {
    measured.tilt.pitch_rad > 0.0
}

/// Torque in N·m, upwards, that turns a thigh to an angle above the level.
fn torque_nm(thigh: &Thigh, wanted_rad: f32) -> f32 {
    NM_PER_RAD * (wanted_rad - thigh.rad) - NMS_PER_RAD * thigh.rps
}
