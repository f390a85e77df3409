//! The key `pc`: what the program on the PC sends over the serial link.

use robot_plant::world::{PcDrive, PcInput, PcJoints};
use serde::Deserialize;

use super::Problem;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Pc {
    on: Option<bool>,
    rate_hz: Option<f64>,
    /// Left, right, rad/s.
    wheels: Option<[f64; 2]>,
    kd: Option<f64>,
    joints: Option<Joints>,
    joint_kp: Option<f64>,
    joint_kd: Option<f64>,
    counts: Option<bool>,
    drive: Option<Drive>,
}

/// Shares of the highest, in place of the sticks. What is not named is 0.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Drive {
    vx: f64,
    wz: f64,
    height: f64,
    roll: f64,
    jump: bool,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Joints {
    Named(String),
    At([f64; 4]),
}

/// A program that is told anything runs, unless it is told to stop.
pub(super) fn read_pc(pc: &Pc) -> Result<PcInput, Problem> {
    if let Some(rate_hz) = pc.rate_hz
        && !(1.0..=PcInput::MAX_RATE_HZ).contains(&rate_hz)
    {
        return Err(Problem::PcRate(rate_hz));
    }
    for wheel in pc.wheels.iter().flatten() {
        within("wheels", *wheel, [-200.0, 200.0])?;
    }
    for (name, gain) in [
        ("kd", pc.kd),
        ("joint_kp", pc.joint_kp),
        ("joint_kd", pc.joint_kd),
    ] {
        within(name, gain.unwrap_or(0.0), [0.0, 1_000.0])?;
    }
    Ok(PcInput {
        on: Some(pc.on.unwrap_or(true)),
        rate_hz: pc.rate_hz,
        wheels_rps: pc.wheels,
        wheel_kd: pc.kd,
        joints: pc.joints.as_ref().map(read_joints).transpose()?,
        joint_kp: pc.joint_kp,
        joint_kd: pc.joint_kd,
        counts: pc.counts,
        drive: pc.drive.as_ref().map(read_drive).transpose()?,
    })
}

fn read_drive(drive: &Drive) -> Result<PcDrive, Problem> {
    let Drive {
        vx,
        wz,
        height,
        roll,
        jump,
    } = *drive;
    for (name, share) in [("vx", vx), ("wz", wz), ("height", height), ("roll", roll)] {
        within(name, share, [-1.0, 1.0])?;
    }
    Ok(PcDrive {
        vx,
        wz,
        height,
        roll,
        jump,
    })
}

fn read_joints(joints: &Joints) -> Result<PcJoints, Problem> {
    match joints {
        Joints::Named(name) => match name.as_str() {
            "hold" => Ok(PcJoints::Hold),
            "limp" => Ok(PcJoints::Limp),
            other => Err(Problem::PcJoints(other.to_owned())),
        },
        Joints::At(angles) => {
            for angle in angles {
                within("joints", *angle, [-3.2, 3.2])?;
            }
            Ok(PcJoints::At(*angles))
        }
    }
}

fn within(name: &'static str, value: f64, [least, most]: [f64; 2]) -> Result<(), Problem> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(Problem::PcField {
        name,
        value,
        least,
        most,
    })
}
