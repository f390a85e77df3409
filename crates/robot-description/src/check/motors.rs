//! Motors: within their data, and in the sense and order that is meant.

use super::{Findings, Severity::Error};
use crate::{
    Robot,
    motor::{C620_MAX_A, M3508_ROTOR_NM_PER_A, M3508_ROTOR_RPS},
};

pub(super) fn check(robot: &Robot, findings: &mut Findings) {
    torques(robot, findings);
    speeds_and_gains(robot, findings);
    angles(robot, findings);
    wheels(robot, findings);
}

fn torques(robot: &Robot, findings: &mut Findings) {
    let joints = &robot.joints;
    let motor = joints.motor.data();
    let name = motor.name;
    for (field, torque_nm, most_nm, which) in [
        (
            "joints.continuous_nm",
            joints.continuous_nm,
            motor.continuous_nm,
            "continuous",
        ),
        ("joints.peak_nm", joints.peak_nm, motor.peak_nm, "peak"),
    ] {
        findings.up_to(
            most_nm,
            &format!("{most_nm} N m, the {which} torque of {name}"),
            field,
            (torque_nm, "N m"),
            "Take the figure of your version's datasheet.",
        );
    }
    let peak_nm = joints.peak_nm;
    findings.note(
        Error,
        joints.continuous_nm <= peak_nm,
        "joints.continuous_nm",
        format!("{} N m", joints.continuous_nm),
        format!("at most peak_nm, {peak_nm} N m"),
        "Take both figures from the same datasheet.",
    );
    findings.up_to(
        peak_nm,
        &format!("peak_nm, {peak_nm} N m"),
        "joints.torque_limit_nm",
        (joints.torque_limit_nm, "N m"),
        "Lower the limit.",
    );
}

fn speeds_and_gains(robot: &Robot, findings: &mut Findings) {
    let joints = &robot.joints;
    let motor = joints.motor.data();
    findings.up_to(
        motor.no_load_rps,
        &format!(
            "{} rad/s, which {} reaches at its highest voltage",
            motor.no_load_rps, motor.name
        ),
        "joints.no_load_rps",
        (joints.no_load_rps, "rad/s"),
        "Scale the datasheet's speed by your battery's voltage, and enter rad/s: rpm times 0.1047.",
    );
    findings.up_to(
        motor.code_rps,
        &format!("{} rad/s, full scale of its frames", motor.code_rps),
        "joints.speed_limit_rps",
        (joints.speed_limit_rps, "rad/s"),
        "Lower the limit.",
    );
    for (field, gain, most) in [
        ("joints.max_kp", joints.max_kp, 500.0),
        ("joints.max_kd", joints.max_kd, 5.0),
    ] {
        findings.note(
            Error,
            (0.0..=most).contains(&gain),
            field,
            format!("{gain}"),
            format!("0 to {most}, full scale of its frames"),
            "Lower the limit.",
        );
    }
}

fn angles(robot: &Robot, findings: &mut Findings) {
    let joints = &robot.joints;
    for (field, [min_rad, max_rad]) in [
        ("joints.range_rad.front", joints.range_rad.front),
        ("joints.range_rad.rear", joints.range_rad.rear),
    ] {
        findings.note(
            Error,
            min_rad < max_rad && min_rad > -std::f64::consts::PI && max_rad < std::f64::consts::PI,
            field,
            format!("{min_rad} to {max_rad} rad"),
            "a lower and an upper limit between -3.14 and 3.14 rad",
            "Turn the joint to both stops and enter the angles, the lower one first.",
        );
    }
    let code_rad = joints.motor.data().code_rad;
    findings.note(
        Error,
        joints
            .zeros_rad
            .iter()
            .all(|zero_rad| zero_rad.abs() < code_rad),
        "joints.zeros_rad",
        format!("{:?} rad", joints.zeros_rad),
        format!("within {code_rad} rad, full scale of the motor's frames"),
        "Set the motor's zero with the thigh level, then enter what is left.",
    );
    senses(
        findings,
        "joints.directions",
        &joints.directions,
        "Lift each front thigh, lower each rear thigh: 1 if the motor's angle grows.",
    );
}

fn senses(findings: &mut Findings, field: &'static str, signs: &[i8], cure: &'static str) {
    findings.note(
        Error,
        signs.iter().all(|sign| sign.abs() == 1),
        field,
        format!("{signs:?}"),
        "1 or -1 for each motor",
        cure,
    );
}

fn wheels(robot: &Robot, findings: &mut Findings) {
    let wheels = &robot.wheels;
    senses(
        findings,
        "wheels.signs",
        &wheels.signs,
        "Roll each wheel forward: 1 if the rotor's speed is positive.",
    );
    findings.up_to(
        C620_MAX_A,
        &format!("{C620_MAX_A} A, what a C620 gives"),
        "wheels.max_current_a",
        (wheels.max_current_a, "A"),
        "Lower the limit.",
    );
    findings.up_to(
        wheels.max_current_a,
        &format!("max_current_a, {} A", wheels.max_current_a),
        "wheels.current_limit_a",
        (wheels.current_limit_a, "A"),
        "Lower the limit.",
    );
    let is_gear = (1.0..=100.0).contains(&wheels.gear_ratio);
    findings.note(
        Error,
        is_gear,
        "wheels.gear_ratio",
        format!("{}", wheels.gear_ratio),
        "1 to 100 rotor turns for one of the wheel",
        "Enter 19.2 for an M3508 with its gear.",
    );
    if is_gear {
        gear(robot, findings);
    }
}

/// What follows from the gear.
fn gear(robot: &Robot, findings: &mut Findings) {
    let wheels = &robot.wheels;
    let usual = M3508_ROTOR_NM_PER_A * wheels.gear_ratio;
    findings.note(
        Error,
        (0.8 * usual..=1.2 * usual).contains(&wheels.torque_nm_per_a),
        "wheels.torque_nm_per_a",
        format!("{} N m/A", wheels.torque_nm_per_a),
        format!("{usual:.3} N m/A within 20 %, an M3508 behind this gear"),
        "Multiply 0.01562 by the gear ratio.",
    );
    let most_rps = 1.1 * M3508_ROTOR_RPS / wheels.gear_ratio;
    findings.up_to(
        most_rps,
        &format!("{most_rps:.1} rad/s, an M3508 behind this gear at 26 V"),
        "wheels.no_load_rps",
        (wheels.no_load_rps, "rad/s"),
        "Scale 970 rad/s of the rotor by your voltage / 24 V and divide it by the gear ratio.",
    );
}
