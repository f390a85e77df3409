//! Joint angles as servo steps.

use std::collections::BTreeMap;

use proptest::prelude::*;
use robot_arm::kinematics::{Gear, KinematicsError, Robot, create_so101_5dof};

fn named(robot: &Robot, steps: [i32; 5]) -> BTreeMap<String, i32> {
    let names = robot.joint_names().map(str::to_owned);
    names.zip(steps).collect()
}

fn names(robot: &Robot) -> Vec<&str> {
    robot.joint_names().collect()
}

#[test]
fn steps_follow_the_formula() {
    let mut robot = create_so101_5dof();
    let home = named(&robot, [2048, 2000, 2100, 2048, 1900]);
    robot
        .set_gear("elbow_flex", Gear::new(-1.0, 3.0).expect("a gear"))
        .expect("a joint");
    let quarter = std::f64::consts::FRAC_PI_2;
    let q = [0.0, quarter, quarter / 3.0, -quarter, 0.001];
    let targets = robot.q_to_servo_targets(&q, &names(&robot), &home);
    // A quarter turn is 1024 steps; 0.001 rad are 0.65 steps.
    let wanted = named(&robot, [2048, 3024, 1076, 1024, 1901]);
    assert_eq!(targets, Ok(wanted));
}

#[test]
fn the_order_is_that_of_the_names() {
    let robot = create_so101_5dof();
    let home = named(&robot, [2048; 5]);
    let names = ["wrist_roll", "shoulder_pan"];
    let targets = robot.q_to_servo_targets(&[0.5, 0.0], &names, &home);
    let targets = targets.expect("targets");
    assert_eq!(targets.len(), 2);
    assert_eq!(targets["wrist_roll"], 2048 + 326);
    let read = robot.read_joint_angles(&names, &home, &targets);
    let read = read.expect("angles");
    assert!((read[0] - 0.5).abs() < 1e-3 && read[1] == 0.0, "{read:?}");
}

#[test]
fn what_is_missing_is_named() {
    let robot = create_so101_5dof();
    let mut home = named(&robot, [2048; 5]);
    let complaint = |q: &[f64], names: &[&str], home: &BTreeMap<String, i32>| {
        let targets = robot.q_to_servo_targets(q, names, home);
        targets.expect_err("refused").to_string()
    };
    let all = names(&robot);
    assert_eq!(
        complaint(&[0.0; 4], &all, &home),
        "q has 4 values, and 5 are needed"
    );
    assert_eq!(
        complaint(&[f64::NAN; 5], &all, &home),
        "q holds NaN or infinity"
    );
    assert_eq!(
        complaint(&[0.0], &["jaw"], &home),
        "there is no joint jaw: the arm has shoulder_pan, shoulder_lift, elbow_flex, wrist_flex, wrist_roll"
    );
    home.remove("wrist_flex");
    let missing = "home_pose has no wrist_flex: it must name each joint that is asked for";
    assert_eq!(complaint(&[0.0; 5], &all, &home), missing);
    let read = robot.read_joint_angles(&["elbow_flex"], &home, &BTreeMap::new());
    assert!(matches!(read, Err(KinematicsError::Missing { what, .. }) if what == "positions"));
}

proptest! {
    #[test]
    fn steps_and_angles_are_each_others_inverse(
        steps in prop::array::uniform5(-5000..10_000),
        homes in prop::array::uniform5(0..4096),
        is_opposite: bool,
        ratio in 0.2..20.0,
    ) {
        let mut robot = create_so101_5dof();
        let gear = Gear::new(if is_opposite { -1.0 } else { 1.0 }, ratio).expect("a gear");
        robot.set_gear("shoulder_lift", gear).expect("a joint");
        let (home, positions) = (named(&robot, homes), named(&robot, steps));
        let all = names(&robot);
        let q = robot.read_joint_angles(&all, &home, &positions).expect("angles");
        prop_assert_eq!(robot.q_to_servo_targets(&q, &all, &home), Ok(positions));
    }
}
