//! The layouts of `robots/*.toml`, made when this crate is built.

use super::{JointMotor, JointSlot, MotorLayout, Schedule, WheelGroup};
use crate::{
    domain::{BusId, JointConfig, robots},
    motor::{dm4310::Dm4310, m3508::EscId, mit::MitRanges, rs00::Rs00},
};

include!(concat!(env!("OUT_DIR"), "/layouts.rs"));

/// Factory setting (docs/hardware.md#dm4310-ranges).
const DM4310_RANGES: MitRanges = MitRanges {
    p_max_rad: 12.5,
    v_max_rps: 30.0,
    t_max_nm: 10.0,
};

const fn esc(number: u8) -> EscId {
    match EscId::new(number) {
        Some(esc) => esc,
        None => unreachable!(),
    }
}

const fn dm4310(number: u8, master_id: u16) -> JointMotor {
    match Dm4310::new(number, master_id, DM4310_RANGES) {
        Some(motor) => JointMotor::Dm4310(motor),
        None => unreachable!(),
    }
}

const fn rs00(number: u8, host: u8) -> JointMotor {
    match Rs00::new(number, host) {
        Some(motor) => JointMotor::Rs00(motor),
        None => unreachable!(),
    }
}

const fn schedule(every: u8, phase: u8) -> Schedule {
    match Schedule::new(every, phase) {
        Some(schedule) => schedule,
        None => unreachable!(),
    }
}
