//! How board and magnetometer sit.

use crate::{
    domain::Orientation,
    tuning::parameter::{Parameter, ParameterKind},
};

const COUNT: usize = Orientation::ALL.len();

/// In the order of their numbers.
static BOARD: [&str; COUNT] = names();
/// `UNSET` after the others.
static MAG: [&str; COUNT + 1] = names();
const UNSET: &str = "unset";

/// Those of the orientations; what is left over is `UNSET`.
const fn names<const N: usize>() -> [&'static str; N] {
    let mut names = [UNSET; N];
    let (mut left, mut all) = (names.as_mut_slice(), Orientation::ALL.as_slice());
    while let ([name, names @ ..], [orientation, orientations @ ..]) = (left, all) {
        *name = orientation.name();
        (left, all) = (names, orientations);
    }
    names
}

/// Their places.
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
