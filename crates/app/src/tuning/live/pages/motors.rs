//! Pages of wheels, joints, and bring-up.

use super::*;
use crate::domain::{JointFeedback, JointState, WheelFeedback};

/// Angle and speed are unknown while the motor is silent.
pub const JOINT: [LiveField; 4] = [
    measure!("angle-rad", "rad", 16, 1_000, |live, part| {
        reporting_joint(live, part).map_or(f32::NAN, |joint| joint.pos_rad)
    }),
    measure!("speed-rps", "rad/s", 16, 100, |live, part| {
        reporting_joint(live, part).map_or(f32::NAN, |joint| joint.vel_rps)
    }),
    choice!(
        "state",
        4,
        &JOINT_STATES,
        |live, part| joint(live, part).state as u32
    ),
    set!(
        "marks",
        2,
        |bit| named(&["frozen", "gives-torque"], bit),
        |live, part| {
            let joint = joint(live, part);
            marks([joint.frozen, joint.reports_enabled])
        }
    ),
];

pub const JOINT_HEALTH: [LiveField; 3] = [
    measure!("temperature-c", "degC", 8, 1, |live, part| {
        reporting_joint(live, part).map_or(f32::NAN, |joint| joint.temperature_c)
    }),
    count!("fault-code", "", 32, |live, part| joint(live, part)
        .fault_code),
    count!("age-ms", "ms", 8, |live, part| joint(live, part).age_us
        / 1_000),
];

/// Rotor speed before the gear, unknown until the motor has reported.
pub const WHEEL: [LiveField; 4] = [
    measure!("rotor-rpm", "rpm", 16, 1, |live, part| {
        reporting_wheel(live, part).map_or(f32::NAN, |wheel| wheel.rpm.into())
    }),
    measure!("temperature-c", "degC", 9, 1, |live, part| {
        reporting_wheel(live, part).map_or(f32::NAN, |wheel| wheel.temperature_c.into())
    }),
    count!("age-ms", "ms", 16, |live, part| wheel(live, part).age_us
        / 1_000),
    set!("marks", 1, |bit| named(&["frozen"], bit), |live, part| {
        marks([wheel(live, part).frozen])
    }),
];

pub const WHEEL_MOTOR: [LiveField; 2] = [
    count!("rotor-angle", "1/8192 turn", 16, |live, part| wheel(
        live, part
    )
    .rotor_angle
    .into()),
    measure!("current-ma", "mA", 16, 1, |live, part| {
        reporting_wheel(live, part).map_or(f32::NAN, |wheel| wheel.current_ma)
    }),
];

pub const BRING_UP: [LiveField; 4] = [
    choice!(
        "step",
        3,
        &["off", "read-only", "zero-torque", "one-motor"],
        |live, _| live.diagnostics.bring_up.step as u32
    ),
    choice!("motor", 3, &MOTORS, |live, _| live
        .diagnostics
        .bring_up
        .motor
        .into()),
    choice!(
        "trial",
        4,
        &TRIALS,
        |live, _| live.diagnostics.bring_up.trial as u32
    ),
    set!("marks", 1, |bit| named(&["by-radio"], bit), |live, _| {
        marks([live.diagnostics.bring_up.by_radio])
    }),
];

/// Motors that block arming, updated while the robot is disarmed.
pub const FINDINGS: [LiveField; 5] = [
    set!(
        "wheels-never-heard",
        2,
        |bit| named(&WHEELS, bit),
        |live, _| { live.diagnostics.motors.wheels_unheard.into() }
    ),
    set!(
        "wheels-doubtful",
        2,
        |bit| named(&WHEELS, bit),
        |live, _| { live.diagnostics.motors.wheels_doubtful.into() }
    ),
    set!("joints-silent", 4, |bit| named(&JOINTS, bit), |live, _| {
        live.diagnostics.motors.joints_silent.into()
    }),
    set!(
        "joints-not-ready",
        4,
        |bit| named(&JOINTS, bit),
        |live, _| { live.diagnostics.motors.joints_unready.into() }
    ),
    set!(
        "joints-out-of-limits",
        4,
        |bit| named(&JOINTS, bit),
        |live, _| { live.diagnostics.motors.joints_outside.into() }
    ),
];

const JOINT_STATES: [&str; 6] = [
    "silent",
    "setting-up",
    "disabled",
    "enabling",
    "enabled",
    "fault",
];
const MOTORS: [&str; 6] = [
    "left-wheel",
    "right-wheel",
    "left-front",
    "left-rear",
    "right-front",
    "right-rear",
];
const TRIALS: [&str; 7] = [
    "idle",
    "release-first",
    "ready",
    "active",
    "too-fast",
    "too-long",
    "silent",
];

/// `part` is a valid index.
fn joint<'a>(live: &LiveSource<'a>, part: usize) -> &'a JointFeedback {
    let joints = &live.diagnostics.sensors.motor.joints;
    let [first, ..] = joints;
    joints.get(part).unwrap_or(first)
}

fn reporting_joint<'a>(live: &LiveSource<'a>, part: usize) -> Option<&'a JointFeedback> {
    Some(joint(live, part)).filter(|joint| joint.ts_us != 0 && joint.state != JointState::Silent)
}

/// `part` is a valid index.
fn wheel<'a>(live: &LiveSource<'a>, part: usize) -> &'a WheelFeedback {
    let wheels = &live.diagnostics.sensors.motor.wheels;
    let [first, ..] = wheels;
    wheels.get(part).unwrap_or(first)
}

fn reporting_wheel<'a>(live: &LiveSource<'a>, part: usize) -> Option<&'a WheelFeedback> {
    Some(wheel(live, part)).filter(|wheel| wheel.ts_us != 0)
}
