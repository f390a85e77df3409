//! Mounting of the board and the magnetometer.

use crate::{
    domain::Orientation,
    tuning::parameter::{Parameter, ParameterKind},
};

const COUNT: usize = Orientation::ALL.len();

/// Names by number.
static BOARD: [&str; COUNT] = names();
/// Names by number, followed by `UNSET`.
static MAG: [&str; COUNT + 1] = names();
const UNSET: &str = "unset";

/// The names of the orientations, filled up with `UNSET`.
const fn names<const N: usize>() -> [&'static str; N] {
    let mut names = [UNSET; N];
    let (mut left, mut all) = (names.as_mut_slice(), Orientation::ALL.as_slice());
    while let ([name, names @ ..], [orientation, orientations @ ..]) = (left, all) {
        *name = orientation.name();
        (left, all) = (names, orientations);
    }
    names
}

/// Largest index of each.
const BOARD_MAX: f32 = (COUNT - 1) as f32;
const MAG_MAX: f32 = COUNT as f32;

pub static MOUNTING: [Parameter; 2] = [
    Parameter {
        index: 0,
        name: "board",
        unit: "",
        min: 0.0,
        max: BOARD_MAX,
        kind: ParameterKind::Choice(&BOARD),
        get: |config| config.mounting.board.number() as f32,
        set: |config, value| {
            config.mounting.board = Orientation::from_number(value as u32).unwrap_or_default();
        },
    },
    Parameter {
        index: 1,
        name: "mag",
        unit: "",
        min: 0.0,
        max: MAG_MAX,
        kind: ParameterKind::Choice(&MAG),
        get: |config| {
            config
                .mounting
                .mag
                .map_or(MAG_MAX, |mag| mag.number() as f32)
        },
        set: |config, value| config.mounting.mag = Orientation::from_number(value as u32),
    },
];
