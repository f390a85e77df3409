//! MuJoCo and yourdfpy read what is written for them, and find the robot of the file.

use std::{fs, path::Path, sync::OnceLock};

use robot_description::{Carrier, Hold, Robot};
use robot_test_support::Python;
use serde_json::Value;

const ROBOTS: [&str; 2] = ["fivebar", "fivebar-rs00"];
/// Of left front, left rear, right front, right rear.
const HIPS_RAD: [f64; 4] = [-0.5, 0.3, 0.2, -0.1];
/// MuJoCo refuses rods without inertia about their length; this much may be seen of it in a mass matrix.
const ALMOST_NONE: f64 = 1e-11;

fn robot(name: &str) -> Robot {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    Robot::read(&robots.join(format!("{name}.toml"))).expect("a robot")
}

/// What the script finds in the files.
fn found(python: &Python, name: &str, robot: &Robot) -> Value {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let write = |kind: &str, text: String| {
        let file = folder.join(format!("{name}-{kind}"));
        fs::write(&file, text).expect("a folder for it");
        file
    };
    let free = write("free.xml", robot.mjcf(Hold::Free));
    let clamped = write("clamped.xml", robot.mjcf(Hold::Clamped));
    let urdf = write("robot.urdf", robot.urdf());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/exports/find.py");
    let mut command = python.command(script);
    command.args([free, clamped, urdf]);
    command.args(HIPS_RAD.map(|it| it.to_string()));
    serde_json::from_slice(&Python::answer(command, "")).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|n| number(&value[n]))
}

fn assert_near<const N: usize>(found: [f64; N], expected: [f64; N], what: &str) {
    let near = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near, "{what}: {found:?} instead of {expected:?}");
}

/// Runs a check on both robots, or says why it is skipped.
fn on_both(check: impl Fn(&Robot, &Value)) {
    static FOUND: OnceLock<[(Robot, Value); 2]> = OnceLock::new();
    let Some(python) = Python::with_science() else {
        return;
    };
    for (robot, found) in FOUND.get_or_init(|| ROBOTS.map(robot_and_files(&python))) {
        check(robot, found);
    }
}

fn robot_and_files(python: &Python) -> impl Fn(&str) -> (Robot, Value) {
    |name| {
        let robot = robot(name);
        let found = found(python, name, &robot);
        (robot, found)
    }
}

#[test]
fn mujoco_and_urdf_weigh_what_the_file_says() {
    on_both(|robot, found| {
        let masses = [
            number(&found["mjcf"]["mass_kg"]),
            number(&found["urdf"]["mass_kg"]),
        ];
        assert_near(masses, [robot.total_mass_kg(); 2], "mass");
    });
}

#[test]
fn mujoco_starts_with_closed_legs_and_wheels_on_the_floor() {
    on_both(|robot, found| {
        let length_m = f64::midpoint(robot.legs.min_m, robot.legs.max_m);
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            for end in ["front", "rear"] {
                let axle = numbers(&found["mjcf"]["axles_m"][format!("{side}_{end}")]);
                let expected = [0.0, sign * robot.legs.plane_y_m, -length_m];
                assert_near(axle, expected, "axle");
            }
            let wheel = numbers(&found["mjcf"]["wheels_m"][side]);
            let expected = [
                0.0,
                sign * robot.wheels.track_m / 2.0,
                robot.wheels.radius_m,
            ];
            assert_near(wheel, expected, "wheel in the world");
        }
    });
}

#[test]
fn hips_turn_as_the_joint_coordinate_says() {
    on_both(|robot, found| {
        let [half_gap, thigh] = [robot.legs.hip_gap_m / 2.0, robot.legs.thigh.length_m];
        for (index, (side, end)) in [
            ("left", "front"),
            ("left", "rear"),
            ("right", "front"),
            ("right", "rear"),
        ]
        .into_iter()
        .enumerate()
        {
            let (sin, cos) = HIPS_RAD[index].sin_cos();
            let out = if end == "front" { 1.0 } else { -1.0 };
            let y = if side == "left" { 1.0 } else { -1.0 } * robot.legs.plane_y_m;
            let knee = [out * (half_gap + thigh * cos), y, out * thigh * sin];
            for kind in ["mjcf", "urdf"] {
                let place = numbers(&found[kind]["knees_m"][format!("{side}_{end}")]);
                assert_near(place, knee, kind);
            }
        }
    });
}

#[test]
fn the_wheel_hangs_on_its_carrier() {
    on_both(|robot, found| {
        let carrier = match robot.wheels.carrier {
            Carrier::Front => "front",
            Carrier::Rear => "rear",
        };
        for side in ["left", "right"] {
            let shank = format!("{side}_{carrier}_shank");
            assert_eq!(found["mjcf"]["wheel_parents"][side], shank);
        }
    });
}

/// MuJoCo reads URDF too. Without loops, rotors and floor both files are one tree.
#[test]
fn urdf_has_the_mass_matrix_and_the_places_of_mjcf() {
    on_both(|_, found| {
        let apart = &found["urdf"]["apart_from_mjcf"];
        for what in ["mass_matrix", "bias_nm", "places_m", "yourdfpy_places_m"] {
            let largest = number(&apart[what]);
            assert!(largest < ALMOST_NONE, "{what} differs by {largest}");
        }
        assert_eq!(found["urdf"]["complaints"], Value::Array(vec![]));
    });
}
