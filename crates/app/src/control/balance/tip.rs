//! Tipping: a robot whose folded legs are held still is one body on wheels. Their torque turns it about the axles.

use super::{law::Torques, measured::Measured, torques, virtual_leg::LegForce};
use crate::{domain::BalanceLimits, kinematics::Leg, math::scalar};

/// Torque of each wheel in N·m/rad of the error of lean, and damping in N·m·s/rad while the robot tips.
const LEAN_NM_PER_RAD: f32 = 8.0;
const LEAN_NMS_PER_RAD: f32 = 0.6;
/// Largest torque of each wheel in N·m. With more the wheels spin.
const MOST_NM: f32 = 2.4;
/// Wheels that spin faster than this in m/s give less, by this many N·m per m/s, until they spin no faster.
const MOST_MPS: f32 = 2.5;
const SPIN_NMS_PER_M: f32 = 5.0;
/// Stiffness and damping across the legs in N·m/rad and N·m·s/rad.
const HOLD_NM_PER_RAD: f32 = 12.0;
const HOLD_NMS_PER_RAD: f32 = 0.6;

/// Torques that turn the robot until its legs do not lean, while each leg gives `push_n`, too little to lift the body from
/// the legs' stops.
pub fn tip(limits: &BalanceLimits, measured: &Measured, push_n: f32) -> Torques {
    held(limits, measured, |_| push_n, wheel_nm(measured))
}

/// Torque of each wheel in N·m for that.
pub fn wheel_nm(measured: &Measured) -> f32 {
    let wanted_nm = lean_nm(
        measured.mean_lean_rad(),
        measured.mean_lean_rps(),
        LEAN_NMS_PER_RAD,
    );
    let most = |room_mps: f32| scalar::clamp(SPIN_NMS_PER_M * room_mps, 0.0, MOST_NM);
    let forward_nm = most(MOST_MPS - measured.speed_mps);
    let backward_nm = most(MOST_MPS + measured.speed_mps);
    scalar::clamp(wanted_nm, -backward_nm, forward_nm)
}

/// Torque of each wheel in N·m that corrects a lean which is off by `off_rad` in rad, and its rate by `off_rps` in rad/s, with this
/// damping in N·m·s/rad.
pub fn lean_nm(off_rad: f32, off_rps: f32, nms_per_rad: f32) -> f32 {
    let wanted_nm = LEAN_NM_PER_RAD * off_rad + nms_per_rad * off_rps;
    scalar::clamp(wanted_nm, -MOST_NM, MOST_NM)
}

/// Torques that turn the legs to the middle of their range while each gives `push_n`.
pub fn held(
    limits: &BalanceLimits,
    measured: &Measured,
    push_n: impl Fn(&Leg) -> f32,
    wheel_nm: f32,
) -> Torques {
    let hips_nm = measured.legs.each_ref().map(|leg: &Leg| {
        let force = LegForce {
            push_n: push_n(leg),
            lean_nm: HOLD_NM_PER_RAD * leg.angle_rad + HOLD_NMS_PER_RAD * leg.angle_rps,
        };
        torques::within_hips(leg, force, wheel_nm, limits.hip_nm)
    });
    Torques {
        wheels_nm: [wheel_nm; 2],
        hips_nm,
    }
}
