//! Identifiers and load of the CAN buses: the rules that the compiler checks again (`MotorLayout` of robot-app).

use super::{Findings, Severity::Error};
use crate::{Bus, JointMotor, Robot, figures};

/// Identifiers of the tuning channel and of a DM4310's registers.
const TUNING_IDS: std::ops::RangeInclusive<u16> = 0x7A0..=0x7A5;
const REGISTER_ID: u16 = 0x7FF;
/// Identifiers that DJI's speed controllers may use, for commands and feedback.
const DJI_IDS: std::ops::RangeInclusive<u16> = 0x1FF..=0x208;
const NAMES: [&str; 4] = ["left front", "left rear", "right front", "right rear"];
const RENUMBER: &str =
    "Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.";

pub(super) fn check(robot: &Robot, findings: &mut Findings) {
    schedule(robot, findings);
    let before = findings.0.len();
    numbers(robot, findings);
    if findings.0.len() == before {
        clashes(robot, findings);
        low_bytes(robot, findings);
    }
    load(robot, findings);
}

fn schedule(robot: &Robot, findings: &mut Findings) {
    let joints = &robot.joints;
    findings.note(
        Error,
        matches!(joints.period_ticks, 1 | 2 | 4 | 8),
        "joints.period_ticks",
        joints.period_ticks.to_string(),
        "1, 2, 4 or 8",
        "Enter 2: each motor gets a command every 2 ms.",
    );
    findings.note(
        Error,
        joints
            .phases
            .iter()
            .all(|phase| *phase < joints.period_ticks.max(1)),
        "joints.phases",
        format!("{:?}", joints.phases),
        format!(
            "0 to {}, less than period_ticks",
            joints.period_ticks.max(1) - 1
        ),
        "Enter 0, 0, 1, 1 with a period of 2.",
    );
}

fn numbers(robot: &Robot, findings: &mut Findings) {
    let [left, right] = robot.wheels.escs;
    findings.note(Error,
        (1..=4).contains(&left) && (1..=4).contains(&right) && left != right,
        "wheels.escs",
        format!("{left}, {right}"),
        "two different numbers, 1 to 4",
        "Press SET on a C620: the number of blinks is its number. Its command frame is that of 1 to 4.",
    );
    let motor = robot.joints.motor.data();
    findings.note(
        Error,
        robot
            .joints
            .ids
            .iter()
            .all(|id| (1..=motor.last_id).contains(id)),
        "joints.ids",
        format!("{:?}", robot.joints.ids),
        format!("1 to {} for {}", motor.last_id, motor.name),
        RENUMBER,
    );
    findings.note(
        Error,
        robot
            .joints
            .replies
            .iter()
            .all(|id| *id <= motor.last_reply),
        "joints.replies",
        hexadecimal(&robot.joints.replies),
        format!("0 to {:#X} for {}", motor.last_reply, motor.name),
        RENUMBER,
    );
}

/// Identifiers of the commands to a joint in its three modes, and of its replies.
fn identifiers(robot: &Robot, joint: usize) -> [u16; 4] {
    let id = u16::from(robot.joints.ids[joint]);
    [id, 0x100 | id, 0x200 | id, robot.joints.replies[joint]]
}

fn shares_bus(robot: &Robot) -> bool {
    robot.wheels.bus == robot.joints.bus
}

fn clashes(robot: &Robot, findings: &mut Findings) {
    for (joint, name) in NAMES.iter().enumerate() {
        let ids = identifiers(robot, joint);
        findings.note(
            Error,
            !ids[..3].contains(&ids[3]),
            "joints.replies",
            format!(
                "{name} replies with {:#X}, the identifier of its commands",
                ids[3]
            ),
            "another identifier",
            RENUMBER,
        );
        reserved(robot, name, ids, findings);
        for (other, other_name) in NAMES.iter().enumerate().skip(joint + 1) {
            let shared = identifiers(robot, other)
                .into_iter()
                .find(|id| ids.contains(id));
            findings.note(
                Error,
                shared.is_none(),
                if robot.joints.ids[joint] == robot.joints.ids[other] {
                    "joints.ids"
                } else {
                    "joints.replies"
                },
                format!(
                    "{name} and {other_name} both use {:#X}",
                    shared.unwrap_or_default()
                ),
                "each identifier once",
                RENUMBER,
            );
        }
    }
}

/// Identifiers that others than motors use.
fn reserved(robot: &Robot, name: &str, ids: [u16; 4], findings: &mut Findings) {
    for id in ids {
        findings.note(
            Error,
            !TUNING_IDS.contains(&id) && id != REGISTER_ID,
            "joints.replies",
            format!("{name} uses {id:#X}, which the tuning channel or the registers use"),
            "an identifier below 0x7A0",
            RENUMBER,
        );
        findings.note(
            Error,
            !shares_bus(robot) || !DJI_IDS.contains(&id),
            "joints.ids",
            format!("{name} uses {id:#X}, as a wheel's speed controller does"),
            "no identifier from 0x1FF to 0x208 on the wheels' bus",
            "Put the joints on the other bus, or give them numbers from 9.",
        );
    }
}

/// A DM4310 takes every frame for its own whose low byte is its number.
fn low_bytes(robot: &Robot, findings: &mut Findings) {
    if robot.joints.motor != JointMotor::Dm4310 {
        return;
    }
    for (joint, name) in NAMES.iter().enumerate() {
        let number = robot.joints.ids[joint];
        let others = (0..4).filter(|other| *other != joint);
        let heard = others.map(|other| robot.joints.replies[other]);
        for id in heard.chain(DJI_IDS.filter(|_| shares_bus(robot))) {
            findings.note(
                Error,
                id.to_be_bytes()[1] != number,
                "joints.replies",
                format!(
                    "{name} has number {number} and would take {id:#X} for a command to itself"
                ),
                "no other frame on the bus whose low byte is a DM4310's number",
                RENUMBER,
            );
        }
    }
}

fn load(robot: &Robot, findings: &mut Findings) {
    for bus in [Bus::Can1, Bus::Can2] {
        let share = figures::bus_load(robot, bus);
        findings.note(
            Error,
            share <= 0.8,
            "joints.period_ticks",
            format!(
                "{} would be loaded to {:.0} %",
                figures::name(bus),
                100.0 * share
            ),
            "80 % of 1 Mb/s",
            "Command the joints less often, or put them on the other bus than the wheels.",
        );
        let most = figures::frames_in_a_tick(robot, bus);
        findings.note(
            Error,
            most <= 2,
            "joints.phases",
            format!(
                "{most} frames for motors start on {} in one tick",
                figures::name(bus)
            ),
            "2, so that one mailbox stays free",
            "Spread the phases.",
        );
    }
}

fn hexadecimal(ids: &[u16]) -> String {
    let words: Vec<_> = ids.iter().map(|id| format!("{id:#X}")).collect();
    words.join(", ")
}
