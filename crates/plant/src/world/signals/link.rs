//! `link.*`: the serial link as the PC receives it, and what reaches the board.

use super::{Signal, World};
use crate::pc::Uplink;

/// Frames that the PC received, and frames that reached the board, undamaged.
pub(super) const COUNTS: &[Signal] = &[
    ("link.up.frames", |w| w.pc.meter.frames() as f64),
    ("link.down.frames", |w| w.pc.down_frames as f64),
];

/// The line to the PC: wrong checksums, bytes outside of frames, characters of another rate or format; rate in Hz, last
/// interval and largest deviation of an interval in µs. Then the fields of the last frame in the document's units, NaN before
/// the first.
pub(super) const UP: &[Signal] = &[
    ("link.up.crc_errors", |w| w.pc.up_errors()[0] as f64),
    ("link.up.discarded_bytes", |w| w.pc.up_errors()[1] as f64),
    ("link.up.unreadable", |w| w.pc.unreadable as f64),
    ("link.up.rate_hz", |w| w.pc.meter.rate_hz(w.now)),
    ("link.up.interval_us", |w| w.pc.meter.interval_us()),
    ("link.up.jitter_us", |w| w.pc.meter.jitter_us()),
    ("link.up.time_s", |w| told(w, |up| up.time_s)),
    ("link.up.battery_v", |w| told(w, |up| up.battery_v)),
    ("link.up.mcu_c", |w| told(w, |up| up.mcu_c)),
    ("link.up.accel.x", |w| told(w, |up| up.accel_mps2[0])),
    ("link.up.accel.y", |w| told(w, |up| up.accel_mps2[1])),
    ("link.up.accel.z", |w| told(w, |up| up.accel_mps2[2])),
    ("link.up.gyro.x", |w| told(w, |up| up.gyro_rps[0])),
    ("link.up.gyro.y", |w| told(w, |up| up.gyro_rps[1])),
    ("link.up.gyro.z", |w| told(w, |up| up.gyro_rps[2])),
    ("link.up.attitude.x", |w| told(w, |up| up.q_xyzw[0])),
    ("link.up.attitude.y", |w| told(w, |up| up.q_xyzw[1])),
    ("link.up.attitude.z", |w| told(w, |up| up.q_xyzw[2])),
    ("link.up.attitude.w", |w| told(w, |up| up.q_xyzw[3])),
    ("link.up.keys.0", |w| told(w, |up| up.keys[0].into())),
    ("link.up.keys.1", |w| told(w, |up| up.keys[1].into())),
    ("link.up.lx", |w| told(w, |up| up.sticks[0])),
    ("link.up.rx", |w| told(w, |up| up.sticks[1])),
    ("link.up.ly", |w| told(w, |up| up.sticks[2])),
    ("link.up.l2", |w| told(w, |up| up.sticks[3])),
    ("link.up.ry", |w| told(w, |up| up.sticks[4])),
];

/// Angle and speed of one motor: wheels left and right, then the joints.
macro_rules! motor_told {
    ($name:literal, $motor:literal) => {
        [
            (concat!("link.up.motor.", $name, ".pos_rad"), |w| {
                told(w, |up| up.motors[$motor].pos_rad)
            }),
            (concat!("link.up.motor.", $name, ".vel_rps"), |w| {
                told(w, |up| up.motors[$motor].vel_rps)
            }),
        ]
    };
}

pub(super) const UP_MOTORS: [[Signal; 2]; 6] = [
    motor_told!("0", 0),
    motor_told!("1", 1),
    motor_told!("2", 2),
    motor_told!("3", 3),
    motor_told!("4", 4),
    motor_told!("5", 5),
];

/// Frames that the PC's program has sent.
pub(super) const DOWN: &[Signal] = &[("link.down.sent", |w| w.pc.sent() as f64)];

/// Target, Kp and Kd of one motor in the last frame that reached the board.
macro_rules! motor_asked {
    ($name:literal, $target:literal, $motor:literal) => {
        [
            (concat!("link.down.motor.", $name, ".", $target), |w| {
                w.pc.asked.motors[$motor].target
            }),
            (concat!("link.down.motor.", $name, ".kp"), |w| {
                w.pc.asked.motors[$motor].kp
            }),
            (concat!("link.down.motor.", $name, ".kd"), |w| {
                w.pc.asked.motors[$motor].kd
            }),
        ]
    };
}

pub(super) const DOWN_MOTORS: [[Signal; 3]; 6] = [
    motor_asked!("0", "speed_rps", 0),
    motor_asked!("1", "speed_rps", 1),
    motor_asked!("2", "pos_rad", 2),
    motor_asked!("3", "pos_rad", 3),
    motor_asked!("4", "pos_rad", 4),
    motor_asked!("5", "pos_rad", 5),
];

fn told(world: &World, field: fn(&Uplink) -> f64) -> f64 {
    world.pc.told.as_ref().map_or(f64::NAN, field)
}
