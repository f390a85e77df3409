//! Torques that the PC of this drive asks for, by the laws of docs/pc-link.md and the motors' datasheets.

use crate::driver::{PC_JOINT_KD, PC_JOINT_KP, PC_JOINT_RAD, PC_WHEEL_KD};

/// M3508 datasheet: 0.3 N·m at the geared output for each ampere.
const NM_PER_MA: f64 = 0.3e-3;
/// The speed behind a current is up to two milliseconds older than the current is seen.
const CURRENT_TOLERANCE_MA: f64 = 600.0;
/// A leg that was let go swings, and the torque was limited by an older report.
const TORQUE_TOLERANCE_NM: f64 = 0.5;
/// The limits of the settings.
const LARGEST_CURRENT_MA: f64 = 8_000.0;
const LARGEST_TORQUE_NM: f64 = 5.0;

/// Whether a wheel's current is zero or what the PC asks for, without regard to its sense.
pub fn wheel_obeys(current_ma: f64, target_rps: f64, speed_rps: f64) -> bool {
    let wanted_ma = PC_WHEEL_KD * (target_rps - speed_rps) / NM_PER_MA;
    let wanted_ma = wanted_ma.abs().min(LARGEST_CURRENT_MA);
    current_ma == 0.0 || (current_ma.abs() - wanted_ma).abs() <= CURRENT_TOLERANCE_MA
}

/// The same for a joint's torque.
pub fn joint_obeys(torque_nm: f64, pos_rad: f64, vel_rps: f64) -> bool {
    let wanted_nm = PC_JOINT_KP * (PC_JOINT_RAD - pos_rad) - PC_JOINT_KD * vel_rps;
    let wanted_nm = wanted_nm.abs().min(LARGEST_TORQUE_NM);
    torque_nm == 0.0 || (torque_nm.abs() - wanted_nm).abs() <= TORQUE_TOLERANCE_NM
}
