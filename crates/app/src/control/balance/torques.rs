//! Torques become commands within the motors' limits, and balance comes first.

use super::virtual_leg::{LegForce, hip_torques_nm, reaction_nm};
use crate::{
    domain::{JointCommand, JointMode},
    kinematics::Leg,
    math::scalar,
};

/// Torques of the left and the right wheel within ±`limit_nm`. What they have in common keeps the balance; the
/// difference, which turns the robot, gets what is left.
pub fn within_wheels(wanted_nm: [f32; 2], limit_nm: f32) -> [f32; 2] {
    let [left_nm, right_nm] = wanted_nm;
    let common_nm = scalar::clamp(0.5 * (left_nm + right_nm), -limit_nm, limit_nm);
    let rest_nm = limit_nm - common_nm.abs();
    let turn_nm = scalar::clamp(0.5 * (right_nm - left_nm), -rest_nm, rest_nm);
    [common_nm - turn_nm, common_nm + turn_nm]
}

/// Torques of the front and the rear hip joint within ±`limit_nm`. The torque that leans the leg and the wheel's
/// reaction keep the balance; the push gets what is left.
pub fn within_hips(leg: &Leg, force: LegForce, wheel_nm: f32, limit_nm: f32) -> [f32; 2] {
    let lean = LegForce {
        push_n: 0.0,
        ..force
    };
    let push = LegForce {
        lean_nm: 0.0,
        ..force
    };
    let [front_lean, rear_lean] = hip_torques_nm(leg, lean);
    let [front_share, rear_share] = reaction_nm(leg, wheel_nm);
    let limited = |nm: f32| scalar::clamp(nm, -limit_nm, limit_nm);
    let (front, rear) = (
        limited(front_lean + front_share),
        limited(rear_lean + rear_share),
    );
    let [front_push, rear_push] = hip_torques_nm(leg, push);
    let part = scalar::min(
        room(front, front_push, limit_nm),
        room(rear, rear_push, limit_nm),
    );
    [front + part * front_push, rear + part * rear_push]
}

/// The part of `more_nm`, 0…1, that fits beside `nm`.
fn room(nm: f32, more_nm: f32, limit_nm: f32) -> f32 {
    let rest_nm = if more_nm < 0.0 {
        limit_nm + nm
    } else {
        limit_nm - nm
    };
    let size = more_nm.abs();
    if size > rest_nm { rest_nm / size } else { 1.0 }
}

/// A joint that gives this torque.
pub const fn joint_command(tau_nm: f32) -> JointCommand {
    JointCommand {
        mode: JointMode::Mit,
        pos_rad: 0.0,
        vel_rps: 0.0,
        kp: 0.0,
        kd: 0.0,
        tau_nm,
    }
}

#[cfg(test)]
mod tests;
