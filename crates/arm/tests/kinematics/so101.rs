//! The SO-101: its table in the code, its URDF, and yourdfpy.

use std::path::Path;

use robot_arm::kinematics::create_so101_5dof;
use robot_test_support::{Python, Random};

use crate::arms;

/// Values of the tool's place in m, computed by hand from the URDF's table.
#[test]
fn the_tool_is_where_the_table_puts_it() {
    let robot = create_so101_5dof();
    for (q, place_m) in [
        ([0.0; 5], [0.3914, 0.0, 0.2265]),
        ([0.5, 0.0, 0.0, 0.0, 0.0], [0.3482, -0.1690, 0.2265]),
        ([0.0, 0.3, 0.0, 0.0, 0.0], [0.4094, 0.0, 0.1264]),
        ([0.0, 0.0, 0.3, 0.0, 0.0], [0.3774, 0.0, 0.1397]),
        ([0.0, 0.0, 0.0, 0.3, 0.0], [0.3819, 0.0, 0.1798]),
        ([0.0, -0.5, 0.5, 0.3, 0.2], [0.3246, -0.0016, 0.1795]),
    ] {
        let pose = robot.fkine(&q).expect("a pose");
        for (ours, wanted) in pose.translation.vector.iter().zip(place_m) {
            assert!((ours - wanted).abs() < 6e-5, "{q:?}: {pose}");
        }
    }
}

#[test]
fn the_built_in_arm_is_that_of_the_urdf() {
    let (built_in, urdf) = (create_so101_5dof(), arms::so101());
    assert_eq!(built_in.joints(), urdf.joints());
    let mut random = Random::new(16);
    for _ in 0..200 {
        let q: Vec<f64> = urdf
            .joints()
            .iter()
            .map(|joint| random.between(joint.lower(), joint.upper()))
            .collect();
        let one = built_in.fkine(&q).expect("a pose").to_homogeneous();
        let other = urdf.fkine(&q).expect("a pose").to_homogeneous();
        assert!((one - other).amax() < 1e-12);
    }
}

#[test]
fn poses_are_those_of_yourdfpy() {
    let Some(python) = Python::with_science() else {
        return;
    };
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut command = python.command(tests.join("python/yourdfpy_poses.py"));
    command.arg(tests.join("data/so101.urdf"));
    let robot = create_so101_5dof();
    let answer = String::from_utf8(Python::answer(command, "")).expect("text");
    let mut rows = 0;
    for line in answer.lines() {
        let numbers: Vec<f64> = line
            .split_whitespace()
            .map(|number| number.parse().expect("a number"))
            .collect();
        let (q, theirs) = numbers.split_at(5);
        let pose = robot.fkine(q).expect("a pose").to_homogeneous();
        let ours = pose.fixed_view::<3, 4>(0, 0).transpose();
        for (ours, theirs) in ours.iter().zip(theirs) {
            assert!((ours - theirs).abs() < 1e-9, "{q:?}: {ours} and {theirs}");
        }
        rows += 1;
    }
    assert_eq!(rows, 200);
}
