//! All live pages. Page numbers and positions of fields are on the wire: add new ones, never move old ones.
//!
//! A new page needs an entry with the next free number here and a line in the table of docs/tuning.md.

use super::{
    LiveField,
    LiveKind::{Choice, Count, Measure, Set},
    LivePage, LiveSource,
};
use crate::safety::{ArmingBlockers, SafetyFlags};

mod balance;
mod link;
mod motors;
mod radio;
mod sensors;
mod system;

/// Names of the wheels, in the order of `ChassisCommand`.
pub const WHEELS: [&str; 2] = ["left", "right"];
/// Names of the joints, in the order of `ChassisCommand`.
pub const JOINTS: [&str; 4] = ["left-front", "left-rear", "right-front", "right-rear"];
const BUSES: [&str; 2] = ["can1", "can2"];
const ROBOT: [&str; 1] = [""];
/// Channel numbers as in docs/driving.md.
const CHANNELS: [&str; 4] = ["0-3", "4-7", "8-11", "12-15"];

/// All pages, by number.
pub static LIVE_PAGES: [LivePage; 41] = [
    page(0x00, "version", &ROBOT, &system::VERSION),
    page(0x01, "run", &ROBOT, &system::RUN),
    page(0x02, "boot", &ROBOT, &system::BOOT),
    page(0x03, "arming", &ROBOT, &system::ARMING),
    page(0x04, "safety", &ROBOT, &system::SAFETY),
    page(0x05, "latched", &ROBOT, &system::LATCHED),
    page(0x06, "seen", &ROBOT, &system::SEEN),
    page(0x07, "power", &ROBOT, &system::POWER),
    page(0x08, "operator", &ROBOT, &radio::OPERATOR),
    page(0x09, "radio", &ROBOT, &radio::LINK),
    page(0x0A, "radio-frames", &ROBOT, &radio::FRAMES),
    page(0x0B, "radio-line", &ROBOT, &radio::LINE),
    page(0x0C, "radio-errors", &ROBOT, &radio::ERRORS),
    page(0x0D, "bring-up", &ROBOT, &motors::BRING_UP),
    page(0x0E, "store", &ROBOT, &system::STORE),
    page(0x0F, "tick", &ROBOT, &system::TICK),
    page(0x10, "channels", &CHANNELS, &radio::CHANNELS),
    page(0x14, "accel", &ROBOT, &sensors::ACCEL),
    page(0x15, "gyro", &ROBOT, &sensors::GYRO),
    page(0x16, "mag", &ROBOT, &sensors::MAG),
    page(0x17, "attitude", &ROBOT, &sensors::ATTITUDE),
    page(0x18, "imu", &ROBOT, &sensors::IMU),
    page(0x19, "sensors", &ROBOT, &sensors::HEALTH),
    page(0x1A, "rejects", &ROBOT, &sensors::REJECTS),
    page(0x1B, "gyro-bias", &ROBOT, &sensors::GYRO_BIAS),
    page(0x1C, "gyro-buffer", &ROBOT, &sensors::GYRO_BUFFER),
    page(0x1D, "motor-findings", &ROBOT, &motors::FINDINGS),
    page(0x1E, "refused", &ROBOT, &system::REFUSED),
    page(0x20, "joint", &JOINTS, &motors::JOINT),
    page(0x24, "joint-health", &JOINTS, &motors::JOINT_HEALTH),
    page(0x28, "wheel", &WHEELS, &motors::WHEEL),
    page(0x2A, "wheel-motor", &WHEELS, &motors::WHEEL_MOTOR),
    page(0x2C, "can", &BUSES, &system::CAN),
    page(0x2E, "can-frames", &BUSES, &system::CAN_FRAMES),
    page(0x30, "strangers", &BUSES, &system::STRANGERS),
    page(0x34, "raw-channels", &CHANNELS, &radio::RAW_CHANNELS),
    page(0x38, "link", &ROBOT, &link::COMMANDS),
    page(0x39, "link-frames", &ROBOT, &link::FRAMES),
    page(0x3A, "link-errors", &ROBOT, &link::ERRORS),
    page(0x3B, "link-tunnel", &ROBOT, &link::TUNNEL),
    page(0x3C, "balance", &ROBOT, &balance::BALANCE),
];

const fn page(
    first: u8,
    name: &'static str,
    parts: &'static [&'static str],
    fields: &'static [LiveField],
) -> LivePage {
    LivePage {
        first,
        name,
        parts,
        fields,
    }
}

/// `count!("name", "unit", bits, |live, part| u32)`.
macro_rules! count {
    ($name:literal, $unit:literal, $bits:literal, $get:expr) => {
        LiveField {
            name: $name,
            unit: $unit,
            bits: $bits,
            kind: Count($get),
        }
    };
}

/// `measure!("name", "unit", bits, steps a unit, |live, part| f32)`.
macro_rules! measure {
    ($name:literal, $unit:literal, $bits:literal, $steps:literal, $get:expr) => {
        LiveField {
            name: $name,
            unit: $unit,
            bits: $bits,
            kind: Measure {
                steps: $steps,
                get: $get,
            },
        }
    };
}

/// `choice!("name", bits, names, |live, part| u32)`.
macro_rules! choice {
    ($name:literal, $bits:literal, $names:expr, $get:expr) => {
        LiveField {
            name: $name,
            unit: "",
            bits: $bits,
            kind: Choice {
                names: $names,
                get: $get,
            },
        }
    };
}

/// `set!("name", bits, |bit| name, |live, part| u32)`.
macro_rules! set {
    ($name:literal, $bits:literal, $name_of:expr, $get:expr) => {
        LiveField {
            name: $name,
            unit: "",
            bits: $bits,
            kind: Set {
                name_of: $name_of,
                get: $get,
            },
        }
    };
}

use {choice, count, measure, set};

/// Packs marks into a set, bit 0 first.
fn marks<const N: usize>(marks: [bool; N]) -> u32 {
    let bits = marks.into_iter().zip(0_u32..);
    bits.fold(0, |set, (mark, bit)| {
        set | u32::from(mark).wrapping_shl(bit)
    })
}

/// Name of a bit by its index.
fn named(names: &[&'static str], bit: u8) -> Option<&'static str> {
    names.get(usize::from(bit)).copied()
}
