//! Checks of a layout, run by the compiler.

#![expect(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    reason = "runs in the compiler, where overflow and bad indices are errors"
)]

use super::{JointMotor, JointSlot, REPLY_PERIOD_TICKS, Schedule, WheelGroup};
use crate::{
    domain::BusId,
    motor::{dm4310, m3508},
};

/// Bits of a standard frame with eight bytes, all possible stuff bits and the intermission.
const FRAME_BITS: u32 = 135;
/// 80 % of 1 Mb/s (docs/figures.md#the-image).
const MAX_BITS_PER_SECOND: u32 = 800_000;
const TICKS_PER_SECOND: u32 = 1_000;
/// One of the controller's three mailboxes stays free for a tuning reply.
const MAX_FRAMES_PER_TICK: u32 = 2;
/// The longest period of a schedule, in ticks.
const TICKS: u8 = 8;
/// First and last identifier of the tuning channel: requests, replies, recorded samples.
const TUNING_IDS: [u16; 2] = [0x7A0, 0x7A5];
/// Identifiers that DJI's speed controllers may use, for commands and feedback.
const FIRST_DJI_ID: u16 = m3508::COMMAND_ID.raw() - 1;
const LAST_DJI_ID: u16 = m3508::COMMAND_ID.raw() + 8;

const LOW_BYTE: u16 = 0xFF;

type Joints = [JointSlot; 4];

const fn same_bus(one: BusId, other: BusId) -> bool {
    one as u8 == other as u8
}

pub const fn load_fits_bus(wheels: &WheelGroup, joints: &Joints) {
    assert!(
        bits_per_second(wheels, joints, BusId::Can1) <= MAX_BITS_PER_SECOND,
        "CAN1 would be loaded above 80 %"
    );
    assert!(
        bits_per_second(wheels, joints, BusId::Can2) <= MAX_BITS_PER_SECOND,
        "CAN2 would be loaded above 80 %"
    );
}

/// The load of a bus. It counts one command frame for all wheels and one feedback frame from each at 1 kHz, a command
/// and a reply for each joint in its slots, a request and a reply in each slot of the tuning channel, and a recorded
/// sample in the ticks between them.
const fn bits_per_second(wheels: &WheelGroup, joints: &Joints, bus: BusId) -> u32 {
    let mut frames = TICKS_PER_SECOND + TICKS_PER_SECOND / REPLY_PERIOD_TICKS;
    if same_bus(wheels.bus, bus) {
        frames += (1 + wheels.escs.len() as u32) * TICKS_PER_SECOND;
    }
    let mut index = 0;
    while index < joints.len() {
        if same_bus(joints[index].bus, bus) {
            frames += 2 * TICKS_PER_SECOND / joints[index].schedule.every as u32;
        }
        index += 1;
    }
    frames * FRAME_BITS
}

pub const fn frames_fit_mailboxes(wheels: &WheelGroup, joints: &Joints) {
    let mut tick = 0;
    while tick < TICKS {
        assert!(
            frames_in_tick(wheels, joints, BusId::Can1, tick) <= MAX_FRAMES_PER_TICK,
            "more than two frames for motors on CAN1 in one tick"
        );
        assert!(
            frames_in_tick(wheels, joints, BusId::Can2, tick) <= MAX_FRAMES_PER_TICK,
            "more than two frames for motors on CAN2 in one tick"
        );
        tick += 1;
    }
}

const fn frames_in_tick(wheels: &WheelGroup, joints: &Joints, bus: BusId, tick: u8) -> u32 {
    let mut frames = same_bus(wheels.bus, bus) as u32;
    let mut index = 0;
    while index < joints.len() {
        let joint = &joints[index];
        frames += (same_bus(joint.bus, bus) && Schedule::is_due(joint.schedule, tick)) as u32;
        index += 1;
    }
    frames
}

pub const fn no_identifier_clashes(wheels: &WheelGroup, joints: &Joints) {
    assert!(
        wheels.escs[0].feedback_id().raw() != wheels.escs[1].feedback_id().raw(),
        "both wheels have the same number"
    );
    let mut one = 0;
    while one < joints.len() {
        assert_reserved_ids_are_free(wheels, &joints[one]);
        assert_own_ids_differ(&joints[one].motor);
        let mut other = one + 1;
        while other < joints.len() {
            if same_bus(joints[one].bus, joints[other].bus) {
                assert_ids_differ(&joints[one].motor, &joints[other].motor);
            }
            other += 1;
        }
        one += 1;
    }
    let mut joint = 0;
    while joint < joints.len() {
        if let JointMotor::Dm4310(_) = joints[joint].motor {
            assert_low_byte_is_unique(wheels, joints, joint);
        }
        joint += 1;
    }
}

/// A DM4310 compares only the low byte of an identifier with its own number. It answers any frame that matches, and
/// executes it if it looks like a service frame (umeow0716/damiao_firmware, `can_protocol.c`). Register frames name
/// the motor in their data.
const fn assert_low_byte_is_unique(wheels: &WheelGroup, joints: &Joints, joint: usize) {
    let number = joints[joint].motor.identifiers()[0].raw() & LOW_BYTE;
    let mut index = 0;
    while index < TUNING_IDS.len() {
        assert_not_addressed(number, TUNING_IDS[index]);
        index += 1;
    }
    let mut id = FIRST_DJI_ID;
    while same_bus(wheels.bus, joints[joint].bus) && id <= LAST_DJI_ID {
        assert_not_addressed(number, id);
        id += 1;
    }
    let mut other = 0;
    while other < joints.len() {
        let ids = joints[other].motor.identifiers();
        let mut index = 0;
        while other != joint && same_bus(joints[other].bus, joints[joint].bus) && index < ids.len()
        {
            assert_not_addressed(number, ids[index].raw());
            index += 1;
        }
        other += 1;
    }
}

const fn assert_not_addressed(number: u16, foreign_id: u16) {
    assert!(
        foreign_id & LOW_BYTE != number,
        "a frame that is not for a DM4310 has its number in the low byte of the identifier"
    );
}

const fn assert_reserved_ids_are_free(wheels: &WheelGroup, joint: &JointSlot) {
    let ids = joint.motor.identifiers();
    let mut index = 0;
    while index < ids.len() {
        let id = ids[index].raw();
        assert!(
            !same_bus(wheels.bus, joint.bus) || id < FIRST_DJI_ID || id > LAST_DJI_ID,
            "a joint uses an identifier of the wheels' speed controllers"
        );
        assert!(
            (id < TUNING_IDS[0] || id > TUNING_IDS[1]) && id != dm4310::REGISTER_ID.raw(),
            "a joint uses an identifier of the tuning channel or of register access"
        );
        index += 1;
    }
}

/// A motor must not take its own reply for a command.
const fn assert_own_ids_differ(motor: &JointMotor) {
    let ids = motor.identifiers();
    let reply = ids[3].raw();
    assert!(
        reply != ids[0].raw() && reply != ids[1].raw() && reply != ids[2].raw(),
        "a joint's reply has the identifier of its commands"
    );
}

/// Two RS00 may not share a host identifier either, although byte 0 of a reply names the motor: simultaneous replies
/// would destroy each other on the bus.
const fn assert_ids_differ(one: &JointMotor, other: &JointMotor) {
    let (one_ids, other_ids) = (one.identifiers(), other.identifiers());
    let mut i = 0;
    while i < one_ids.len() {
        let mut k = 0;
        while k < other_ids.len() {
            assert!(
                one_ids[i].raw() != other_ids[k].raw(),
                "two joints on one bus use the same identifier"
            );
            k += 1;
        }
        i += 1;
    }
}

pub const fn limits_are_sound(wheels: &WheelGroup, joints: &Joints) {
    assert!(
        wheels.max_current_ma >= 0.0,
        "a wheel's current limit is negative"
    );
    let mut index = 0;
    while index < joints.len() {
        let config = &joints[index].config;
        assert!(
            config.direction == 1.0 || config.direction == -1.0,
            "a joint's direction is neither +1 nor -1"
        );
        assert!(
            config.min_rad < config.max_rad,
            "a joint's soft limits are in the wrong order"
        );
        assert!(
            config.max_torque_nm >= 0.0 && config.max_torque_nm <= joints[index].max_torque_nm,
            "a joint's torque limit is beyond what its motor may give"
        );
        index += 1;
    }
}
