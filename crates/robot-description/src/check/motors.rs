//! Motors: within their data, and in the sense and order that is meant.

use super::Findings;
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
    for (field, torque_nm, most_nm, which) in [
        (
            "joints.continuous_nm",
            joints.continuous_nm,
            motor.continuous_nm,
            "continuous torque",
        ),
        (
            "joints.peak_nm",
            joints.peak_nm,
            motor.peak_nm,
            "peak torque",
        ),
    ] {
        findings.must(
            torque_nm > 0.0 && torque_nm <= most_nm,
            field,
            format!("{torque_nm} N m"),
            format!(
                "more than 0, at most {most_nm} N m, the {which} of {}",
                motor.name
            ),
            "Take the figure of your version's datasheet.",
        );
    }
    let peak_nm = joints.peak_nm;
    findings.must(
        joints.continuous_nm <= peak_nm,
        "joints.continuous_nm",
        format!("{} N m", joints.continuous_nm),
        format!("at most peak_nm, {peak_nm} N m"),
        "Take both figures from the same datasheet.",
    );
    findings.must(
        joints.torque_limit_nm > 0.0 && joints.torque_limit_nm <= peak_nm,
        "joints.torque_limit_nm",
        format!("{} N m", joints.torque_limit_nm),
        format!("more than 0, at most peak_nm, {peak_nm} N m"),
        "Lower the limit.",
    );
}

fn speeds_and_gains(robot: &Robot, findings: &mut Findings) {
    let joints = &robot.joints;
    let motor = joints.motor.data();
    findings.must(
        joints.no_load_rps > 0.0 && joints.no_load_rps <= motor.no_load_rps,
        "joints.no_load_rps",
        format!("{} rad/s", joints.no_load_rps),
        format!(
            "more than 0, at most {} rad/s, which {} reaches at its highest voltage",
            motor.no_load_rps, motor.name
        ),
        "Scale the datasheet's speed by your battery's voltage, and enter rad/s: rpm times 0.1047.",
    );
    findings.must(
        joints.speed_limit_rps > 0.0 && joints.speed_limit_rps <= motor.code_rps,
        "joints.speed_limit_rps",
        format!("{} rad/s", joints.speed_limit_rps),
        format!(
            "more than 0, at most {} rad/s, full scale of its frames",
            motor.code_rps
        ),
        "Lower the limit.",
    );
    for (field, gain, most) in [
        ("joints.max_kp", joints.max_kp, 500.0),
        ("joints.max_kd", joints.max_kd, 5.0),
    ] {
        findings.must(
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
        findings.must(
            min_rad < max_rad && min_rad > -std::f64::consts::PI && max_rad < std::f64::consts::PI,
            field,
            format!("{min_rad} to {max_rad} rad"),
            "a lower and an upper limit between -3.14 and 3.14 rad",
            "Turn the joint to both stops and enter the angles, the lower one first.",
        );
    }
    let code_rad = joints.motor.data().code_rad;
    findings.must(
        joints
            .zeros_rad
            .iter()
            .all(|zero_rad| zero_rad.abs() < code_rad),
        "joints.zeros_rad",
        format!("{:?} rad", joints.zeros_rad),
        format!("within {code_rad} rad, full scale of the motor's frames"),
        "Set the motor's zero with the thigh level, then enter what is left.",
    );
    findings.must(
        joints.directions.iter().all(|sign| sign.abs() == 1),
        "joints.directions",
        format!("{:?}", joints.directions),
        "1 or -1 for each motor",
        "Lift each front thigh, lower each rear thigh: 1 if the motor's angle grows.",
    );
}

fn wheels(robot: &Robot, findings: &mut Findings) {
    let wheels = &robot.wheels;
    findings.must(
        wheels.signs.iter().all(|sign| sign.abs() == 1),
        "wheels.signs",
        format!("{:?}", wheels.signs),
        "1 or -1 for each motor",
        "Roll each wheel forward: 1 if the rotor's speed is positive.",
    );
    findings.must(
        (1.0..=100.0).contains(&wheels.gear_ratio),
        "wheels.gear_ratio",
        format!("{}", wheels.gear_ratio),
        "1 to 100 rotor turns for one of the wheel",
        "Enter 19.2 for an M3508 with its gear.",
    );
    findings.must(
        wheels.max_current_a > 0.0 && wheels.max_current_a <= C620_MAX_A,
        "wheels.max_current_a",
        format!("{} A", wheels.max_current_a),
        format!("more than 0, at most {C620_MAX_A} A, what a C620 gives"),
        "Lower the limit.",
    );
    findings.must(
        wheels.current_limit_a > 0.0 && wheels.current_limit_a <= wheels.max_current_a,
        "wheels.current_limit_a",
        format!("{} A", wheels.current_limit_a),
        format!(
            "more than 0, at most max_current_a, {} A",
            wheels.max_current_a
        ),
        "Lower the limit.",
    );
    gear(robot, findings);
}

/// What follows from the gear.
fn gear(robot: &Robot, findings: &mut Findings) {
    let wheels = &robot.wheels;
    if !(1.0..=100.0).contains(&wheels.gear_ratio) {
        return;
    }
    let usual = M3508_ROTOR_NM_PER_A * wheels.gear_ratio;
    findings.must(
        (0.8 * usual..=1.2 * usual).contains(&wheels.torque_nm_per_a),
        "wheels.torque_nm_per_a",
        format!("{} N m/A", wheels.torque_nm_per_a),
        format!("{usual:.3} N m/A within 20 %, an M3508 behind this gear"),
        "Multiply 0.01562 by the gear ratio.",
    );
    let usual = M3508_ROTOR_RPS / wheels.gear_ratio;
    findings.must(
        wheels.no_load_rps > 0.0 && wheels.no_load_rps <= 1.1 * usual,
        "wheels.no_load_rps",
        format!("{} rad/s", wheels.no_load_rps),
        format!(
            "more than 0, at most {:.1} rad/s, an M3508 behind this gear at 26 V",
            1.1 * usual
        ),
        "Scale 970 rad/s of the rotor by your voltage / 24 V and divide it by the gear ratio.",
    );
}
