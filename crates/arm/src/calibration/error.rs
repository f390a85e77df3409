//! What can be wrong with a calibration, with what to do about it.

use std::{io, path::PathBuf};

#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    #[error(
        "cannot read {path}: {source}. `armctl calibrate` makes such a file, and servo_config.json of your arm is one"
    )]
    Read { path: PathBuf, source: io::Error },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: io::Error },
    #[error("{file} is no JSON: {source}. JSON has no comments and no comma after the last entry")]
    Json {
        file: String,
        source: serde_json::Error,
    },
    #[error("{file} has no joints: it is {{\"NAME\": {{\"id\": 1, …}}, …}}")]
    Empty { file: String },
    #[error("{file}: {joint}: {problem}")]
    Joint {
        file: String,
        joint: String,
        problem: Problem,
    },
}

/// What is wrong with one joint.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    #[error(
        "is {value}, but a joint is {{\"id\": …, \"homing_offset\": …, \"range_min\": …, \"range_max\": …}}"
    )]
    NoObject { value: String },
    #[error("{field} is missing: add it, or calibrate the arm again (`armctl calibrate`)")]
    Missing { field: &'static str },
    #[error(
        "{field} is unknown, and would be lost: a joint has id, homing_offset, range_min, range_max, and in LeRobot's files \
         drive_mode"
    )]
    Unknown { field: String },
    #[error("{field} = {value}, but it takes whole numbers from {least} to {most}: {cure}")]
    Value {
        field: &'static str,
        value: String,
        least: i64,
        most: i64,
        cure: &'static str,
    },
    #[error("range_min = {min} is not below range_max = {max}: calibrate this joint again")]
    EmptyRange { min: i32, max: i32 },
    #[error(
        "id = {id} is that of {other} too: give one of the two servos another (`armctl set-id`)"
    )]
    SameId { id: u8, other: String },
    #[error("is there twice: remove one of the two")]
    Twice,
    #[error("has a drive_mode, and other joints have none: a file is LeRobot's or a plain one")]
    Mixed,
    #[error(
        "drive_mode = 1 has no place in a plain file: put the joint's direction into the model (gear_sign) and convert with \
         drive_mode = 0"
    )]
    DriveMode,
    #[error(
        "its travel, steps {from} to {to} without the servo's offset, crosses the seam between 4095 and 0, which a plain file \
         cannot say: keep LeRobot's file, which armctl takes as well, or turn the horn on its shaft and calibrate again"
    )]
    Seam { from: i32, to: i32 },
}
