//! What is known of motors.

use serde::Deserialize;

/// Make of the hip motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JointMotor {
    /// Damiao DM4310.
    Dm4310,
    /// RobStride RS00.
    Rs00,
}

/// What a hip motor can do at most, by its datasheet (docs/hardware.md).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointMotorData {
    /// Name as people write it.
    pub(crate) name: &'static str,
    /// Of the strongest version, in N·m.
    pub(crate) continuous_nm: f64,
    /// Of the strongest version, and no more than its frames can carry.
    pub(crate) peak_nm: f64,
    /// Speed in rad/s without load at its highest voltage.
    pub(crate) no_load_rps: f64,
    /// Full scale of the angle in its frames in rad.
    pub(crate) code_rad: f64,
    /// Full scale of the speed in its frames in rad/s.
    pub(crate) code_rps: f64,
    /// Fall of the speed under load in rad/s per N·m.
    pub(crate) slope_rps_per_nm: f64,
    /// Largest number.
    pub(crate) last_id: u8,
    /// Largest identifier of replies.
    pub(crate) last_reply: u16,
}

impl JointMotor {
    pub(crate) fn data(self) -> &'static JointMotorData {
        match self {
            Self::Dm4310 => &DM4310,
            Self::Rs00 => &RS00,
        }
    }
}

/// 120 rpm at 3 N·m make the slope.
const DM4310: JointMotorData = JointMotorData {
    name: "a DM4310",
    continuous_nm: 3.5,
    peak_nm: 10.0,
    no_load_rps: 24.0,
    code_rad: 12.5,
    code_rps: 30.0,
    slope_rps_per_nm: 2.79,
    last_id: 15,
    last_reply: 0x7FF,
};

/// The slope is assumed: at 24 V the peak is just reached at standstill.
const RS00: JointMotorData = JointMotorData {
    name: "an RS00",
    continuous_nm: 5.0,
    peak_nm: 14.0,
    no_load_rps: 41.0,
    code_rad: 12.57,
    code_rps: 33.0,
    slope_rps_per_nm: 1.19,
    last_id: 127,
    last_reply: 0xFF,
};

/// Torque constant of an M3508's rotor in N·m/A.
pub(crate) const M3508_ROTOR_NM_PER_A: f64 = 0.3 * 187.0 / 3591.0;
/// Speed of an M3508's rotor in rad/s without load at 24 V: 482 rpm behind its gear.
pub(crate) const M3508_ROTOR_RPS: f64 = 482.0 * std::f64::consts::TAU / 60.0 * 3591.0 / 187.0;
/// Largest current of a C620 in A.
pub(crate) const C620_MAX_A: f64 = 20.0;
