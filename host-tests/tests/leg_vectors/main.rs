//! The firmware's leg kinematics give the places and slopes that MuJoCo finds.
//!
//! `small_rear.csv` and `large_front.csv` were made by `make.py`; their columns stand there. Where MuJoCo is installed,
//! they are made again and compared.

use std::{fs, path::Path};

use robot_app::{
    domain::{Carrier, LegGeometry},
    kinematics::Leg,
};
use robot_description::{Hold, Robot};
use robot_test_support::Python;

/// f32 and the firmware's own scalar functions.
const NEAR: f64 = 3e-6;
/// Ten digits are in the file.
const SAME: f64 = 2e-10;
const COLUMNS: usize = 10;

type Row = [f64; COLUMNS];

struct Vectors {
    name: &'static str,
    text: &'static str,
    geometry: LegGeometry,
    /// Leg length in m with which MuJoCo starts.
    start_m: f64,
}

const VECTORS: [Vectors; 2] = [
    Vectors {
        name: "small_rear",
        text: include_str!("small_rear.csv"),
        geometry: LegGeometry {
            hip_gap_m: 0.10,
            thigh_m: 0.12,
            shank_m: 0.22,
            carrier: Carrier::Rear,
        },
        start_m: 0.2,
    },
    Vectors {
        name: "large_front",
        text: include_str!("large_front.csv"),
        geometry: LegGeometry {
            hip_gap_m: 0.15,
            thigh_m: 0.15,
            shank_m: 0.27,
            carrier: Carrier::Front,
        },
        start_m: 0.25,
    },
];

fn rows(text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|it| it.parse().expect("a number"))
            .collect();
        Row::try_from(numbers).expect("so many columns")
    };
    text.lines().map(row).collect()
}

fn by_firmware(geometry: &LegGeometry, [front, rear]: [f64; 2]) -> Row {
    let leg = Leg::new(geometry, [front as f32, rear as f32], [1.0, 0.0]);
    assert!(leg.fits, "{front} {rear}");
    let [length, angle, carrier] =
        [leg.length_per_rad, leg.angle_per_rad, leg.carrier_per_rad].map(|it| it.map(f64::from));
    // A front hip at 1 rad/s moves everything by its slope.
    let rates = [leg.length_mps, leg.angle_rps, leg.carrier_rps];
    assert_eq!(rates.map(f64::from), [length[0], angle[0], carrier[0]]);
    [
        front,
        rear,
        f64::from(leg.length_m),
        f64::from(leg.angle_rad),
        length[0],
        length[1],
        angle[0],
        angle[1],
        carrier[0],
        carrier[1],
    ]
}

#[test]
fn length_angle_and_slopes_are_those_of_mujoco() {
    for vectors in VECTORS {
        let rows = rows(vectors.text);
        assert!(rows.len() > 60, "{}", rows.len());
        for expected in rows {
            let found = by_firmware(&vectors.geometry, [expected[0], expected[1]]);
            for (found, expected) in found.iter().zip(expected) {
                let error = (found - expected).abs() / expected.abs().max(1.0);
                assert!(
                    error < NEAR,
                    "{}: {found} instead of {expected}",
                    vectors.name
                );
            }
        }
    }
}

/// A robot of the tree with legs of another size.
fn mjcf(vectors: &Vectors) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/fivebar.toml");
    let mut robot = Robot::read(&file).expect("a robot");
    let millimetres = |length: f32| (f64::from(length) * 1e3).round() / 1e3;
    robot.legs.hip_gap_m = millimetres(vectors.geometry.hip_gap_m);
    robot.legs.thigh.length_m = millimetres(vectors.geometry.thigh_m);
    robot.legs.shank.length_m = millimetres(vectors.geometry.shank_m);
    [robot.legs.min_m, robot.legs.max_m] = [vectors.start_m; 2];
    robot.wheels.carrier = match vectors.geometry.carrier {
        Carrier::Front => robot_description::Carrier::Front,
        Carrier::Rear => robot_description::Carrier::Rear,
    };
    robot.mjcf(Hold::Clamped)
}

#[test]
fn mujoco_gives_these_vectors_again() {
    let Some(python) = Python::with_science() else {
        return;
    };
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/leg_vectors");
    for vectors in VECTORS {
        let model = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.xml", vectors.name));
        fs::write(&model, mjcf(&vectors)).expect("a folder for it");
        let mut command = python.command(tests.join("make.py"));
        let output = command.arg(model).output().expect("it starts");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{stderr}");
        let made = String::from_utf8(output.stdout).expect("text");
        let (made, kept) = (rows(&made), rows(vectors.text));
        assert_eq!(made.len(), kept.len());
        let pairs = made.iter().flatten().zip(kept.iter().flatten());
        let worst = pairs.fold(0.0_f64, |it, (a, b)| it.max((a - b).abs()));
        assert!(worst < SAME, "{}: {worst}", vectors.name);
    }
}
