//! The joint controller, and the place and limits of each joint.

use crate::tuning::parameter::{Parameter, ParameterKind, float, integer, sign};

/// Limits of an MIT frame, the same for DM4310 and RS00 (docs/hardware.md#mit-frames).
const MAX_KP: f32 = 500.0;
const MAX_KD: f32 = 5.0;
/// The wider of both motors' ranges (RS00: 4π rad, 33 rad/s, 14 N·m). Each motor's own range applies as well.
const MAX_RAD: f32 = 12.57;
pub const MAX_RPS: f32 = 33.0;
pub const MAX_NM: f32 = 14.0;

#[rustfmt::skip] // One line a setting.
pub static CONTROLLER: [Parameter; 3] = [
    float!(0, "hold-kp", "N*m/rad", 0.0, MAX_KP, joint_ctrl.hold_kp),
    float!(1, "hold-kd", "N*m*s/rad", 0.0, MAX_KD, joint_ctrl.hold_kd),
    integer!(2, "rs00-timeout-set", "", 0.0, 1.0, joint_ctrl.rs00_timeout_set),
];

#[rustfmt::skip] // One line a setting.
macro_rules! joint {
    ($number:literal) => {
        [
            sign!(0, "direction", joints[$number].direction),
            float!(1, "zero-rad", "rad", -MAX_RAD, MAX_RAD, joints[$number].zero_rad),
            float!(2, "min-rad", "rad", -MAX_RAD, MAX_RAD, joints[$number].min_rad),
            float!(3, "max-rad", "rad", -MAX_RAD, MAX_RAD, joints[$number].max_rad),
            float!(4, "max-torque-nm", "N*m", 0.0, MAX_NM, joints[$number].max_torque_nm),
            float!(5, "max-speed-rps", "rad/s", 0.0, MAX_RPS, joints[$number].max_speed_rps),
            float!(6, "max-kp", "N*m/rad", 0.0, MAX_KP, joints[$number].max_kp),
            float!(7, "max-kd", "N*m*s/rad", 0.0, MAX_KD, joints[$number].max_kd),
        ]
    };
}

pub static LEFT_FRONT: [Parameter; 8] = joint!(0);
pub static LEFT_REAR: [Parameter; 8] = joint!(1);
pub static RIGHT_FRONT: [Parameter; 8] = joint!(2);
pub static RIGHT_REAR: [Parameter; 8] = joint!(3);
