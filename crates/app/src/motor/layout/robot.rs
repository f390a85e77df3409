//! The layouts of this robot: two M3508 on CAN1 and four joints on CAN2, two of them in each tick.

use super::{JointMotor, JointSlot, MotorLayout, Schedule, WheelGroup};
use crate::{
    domain::{BusId, JointConfig},
    motor::{dm4310::Dm4310, m3508::EscId, mit::MitRanges, rs00::Rs00},
};

/// The layout with DM4310 joints: commands 0x001…0x004, replies 0x011…0x014.
pub const ROBOT_LAYOUT: MotorLayout = MotorLayout::new(
    WHEELS,
    [
        dm4310_joint(1, LEFT),
        dm4310_joint(2, LEFT),
        dm4310_joint(3, RIGHT),
        dm4310_joint(4, RIGHT),
    ],
);

/// The layout with RS00 joints: commands 0x001…0x004, replies 0x0F1…0x0F4. Each motor has its own host identifier.
/// With a shared one, simultaneous replies would collide and be lost.
pub const RS00_LAYOUT: MotorLayout = MotorLayout::new(
    WHEELS,
    [
        rs00_joint(1, LEFT),
        rs00_joint(2, LEFT),
        rs00_joint(3, RIGHT),
        rs00_joint(4, RIGHT),
    ],
);

const WHEELS: WheelGroup = WheelGroup {
    bus: BusId::Can1,
    escs: [esc(1), esc(2)],
    max_current_ma: MAX_WHEEL_MA,
};

/// Continuous current of an M3508, half of what its speed controller can give.
const MAX_WHEEL_MA: f32 = 10_000.0;

/// Factory setting (docs/hardware.md#dm4310-ranges).
const DM4310_RANGES: MitRanges = MitRanges {
    p_max_rad: 12.5,
    v_max_rps: 30.0,
    t_max_nm: 10.0,
};
/// Peak torque of the weaker version of the motor.
const DM4310_PEAK_NM: f32 = 7.0;
const RS00_PEAK_NM: f32 = 14.0;

const LEFT: JointConfig = JointConfig {
    direction: 1.0,
    zero_rad: 0.0,
    min_rad: -1.5,
    max_rad: 1.5,
    max_torque_nm: 3.0,
    max_speed_rps: 15.0,
    max_kp: 100.0,
    max_kd: 5.0,
};
/// The right side is mirrored.
const RIGHT: JointConfig = JointConfig {
    direction: -1.0,
    ..LEFT
};

const fn esc(number: u8) -> EscId {
    match EscId::new(number) {
        Some(esc) => esc,
        None => unreachable!(),
    }
}

const fn dm4310_joint(number: u8, config: JointConfig) -> JointSlot {
    match Dm4310::new(number, 0x10 | number as u16, DM4310_RANGES) {
        Some(motor) => joint(number, JointMotor::Dm4310(motor), config, DM4310_PEAK_NM),
        None => unreachable!(),
    }
}

const fn rs00_joint(number: u8, config: JointConfig) -> JointSlot {
    match Rs00::new(number, 0xF0 | number) {
        Some(motor) => joint(number, JointMotor::Rs00(motor), config, RS00_PEAK_NM),
        None => unreachable!(),
    }
}

/// Motors 1 and 2 (left) have even ticks, 3 and 4 (right) odd ones.
const fn joint(
    number: u8,
    motor: JointMotor,
    config: JointConfig,
    max_torque_nm: f32,
) -> JointSlot {
    match Schedule::new(2, (number > 2) as u8) {
        Some(schedule) => JointSlot {
            bus: BusId::Can2,
            motor,
            schedule,
            config,
            max_torque_nm,
        },
        None => unreachable!(),
    }
}
