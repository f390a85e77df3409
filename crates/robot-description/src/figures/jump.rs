//! The highest jump: the legs stretch from short to long with all the torque that the hips have at their speed.

use super::{GRAVITY_MPS2, leverage};
use crate::Robot;

/// The highest jump of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// Time in s from the shortest leg to the longest.
    pub push_s: f64,
    /// Speed in m/s of the body at take-off.
    pub take_off_mps: f64,
    /// Speed in rad/s of the hips at take-off.
    pub hip_rps: f64,
    /// Height in m that the centre of mass rises after take-off.
    pub rise_m: f64,
    /// Height in m of the wheels above the ground, with the legs drawn in again.
    pub clearance_m: f64,
}

const DT_S: f64 = 2e-4;
/// After that time the legs do not stretch at all.
const LONGEST_S: f64 = 1.0;

/// The body goes straight up, both legs alike, wheels on the ground until the legs are at their longest. Rotors of the hips
/// are accelerated too.
pub(crate) fn jump(robot: &Robot) -> Jump {
    let (legs, joints) = (&robot.legs, &robot.joints);
    let split = robot.split_mass();
    let slope = joints.motor.data().slope_rps_per_nm;
    let (mut length_m, mut speed_mps, mut time_s) = (legs.min_m, 0.0_f64, 0.0);
    let mut hip_rps = 0.0;
    while length_m < legs.max_m && time_s < LONGEST_S {
        // Both hips of a leg turn alike, so the leg grows by twice this for each rad.
        let arm_m = leverage(robot, length_m);
        hip_rps = speed_mps / (2.0 * arm_m);
        let torque_nm = ((joints.no_load_rps - hip_rps) / slope).min(joints.torque_limit_nm);
        let force_n = 2.0 * torque_nm / arm_m - split.carried_kg * GRAVITY_MPS2;
        let rotors_kg = 4.0 * joints.armature_kgm2 / (2.0 * arm_m).powi(2);
        speed_mps = (speed_mps + force_n / (split.carried_kg + rotors_kg) * DT_S).max(0.0);
        length_m += speed_mps * DT_S;
        time_s += DT_S;
    }
    if length_m < legs.max_m {
        speed_mps = 0.0;
    }
    // The wheels are pulled along.
    let share = split.carried_kg / (split.carried_kg + 2.0 * split.axle_kg);
    let rise_m = (share * speed_mps).powi(2) / (2.0 * GRAVITY_MPS2);
    let [low_m, _] = robot.control.limits.height_m;
    let drawn_in_m = if speed_mps > 0.0 {
        share * (legs.max_m - low_m)
    } else {
        0.0
    };
    Jump {
        push_s: time_s,
        take_off_mps: speed_mps,
        hip_rps,
        rise_m,
        clearance_m: rise_m + drawn_in_m,
    }
}
