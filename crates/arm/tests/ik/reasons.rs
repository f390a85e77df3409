//! Poses that cannot be reached, and questions that are none.

use nalgebra::{IsometryMatrix3, Matrix4, Rotation3, Translation3, Vector3};
use proptest::prelude::*;
use robot_arm::{
    ik::{Mask, Outcome, Solution, Solver, pose_of},
    kinematics::{Robot, create_so101_5dof},
};
use robot_test_support::Random;

use crate::{
    arms,
    judge::{any_values, error, is_within_limits},
};

fn at(x: f64, y: f64, z: f64) -> IsometryMatrix3<f64> {
    IsometryMatrix3::from_parts(Translation3::new(x, y, z), Rotation3::identity())
}

fn solve(robot: &Robot, target: &IsometryMatrix3<f64>, mask: Mask) -> Solution {
    let solution = Solver::default().solve(robot, target, &[0.0; 5], mask);
    solution.expect("a sound question")
}

#[test]
fn a_place_out_of_reach_gives_the_nearest_one() {
    let robot = create_so101_5dof();
    let target = at(0.6, 0.3, 0.4);
    let solution = solve(&robot, &target, Mask::POSITION);
    assert_eq!(solution.outcome, Outcome::OutOfReach);
    let reason = solution.reason();
    assert!(reason.starts_with("out of reach: 0."), "{reason}");
    let ours = error(&robot, &solution.q, &target, Mask::POSITION).norm();
    assert!((ours - solution.remaining.position_m).abs() < 1e-9);
    let mut random = Random::new(3);
    let mut tried = (0..200_000).map(|_| {
        let q = any_values(&robot, &mut random);
        error(&robot, &q, &target, Mask::POSITION).norm()
    });
    assert!(
        tried.all(|distance| distance > ours - 1e-9),
        "{ours} is not the least"
    );
}

#[test]
fn a_joint_that_would_have_to_go_further_is_named() {
    let to = |limit| arms::SO101_URDF.replace("lower=\"-1.91986\" upper=\"1.91986\"", limit);
    let urdf = to("lower=\"-0.5\" upper=\"0.5\"");
    let narrow = Robot::from_urdf(&urdf, None, Some("gripper_frame_link")).expect("an arm");
    let wide = create_so101_5dof();
    let target = wide.fkine(&[1.2, 0.1, 0.1, 0.1, 0.0]).expect("a pose");
    assert!(solve(&wide, &target, Mask::POSITION).success());
    let solution = solve(&narrow, &target, Mask::POSITION);
    let Outcome::AtLimits(joints) = &solution.outcome else {
        panic!("{solution:?}");
    };
    assert!(joints.contains(&"shoulder_pan".to_owned()), "{joints:?}");
    let reason = solution.reason();
    assert!(
        reason.starts_with("at the limits of shoulder_pan"),
        "{reason}"
    );
}

#[test]
fn a_mask_that_asks_for_too_much_is_named() {
    let robot = create_so101_5dof();
    let sideways = Rotation3::from_axis_angle(&Vector3::x_axis(), 1.2);
    let target = IsometryMatrix3::from_parts(Translation3::new(0.25, 0.1, 0.2), sideways);
    let solution = solve(&robot, &target, Mask::POSE);
    assert_eq!(
        solution.outcome,
        Outcome::MaskTooWide { axes: 6, joints: 5 }
    );
    let reason = solution.reason();
    assert!(reason.starts_with("the mask counts 6 parts of the pose, and the arm has 5 joints: "));
    assert!(solve(&robot, &target, Mask::POSITION).success());
}

#[test]
fn questions_that_are_none_are_answered_in_words() {
    let robot = create_so101_5dof();
    let home = robot.fkine(&[0.0; 5]).expect("a pose").to_homogeneous();
    let said = |tep: &Matrix4<f64>, q0: &[f64], mask| {
        let (q, success, reason) = robot.ikine_lm(tep, Some(q0), mask);
        assert!(!success && q.len() == q0.len());
        reason
    };
    let q0 = [0.0; 5];
    assert_eq!(
        said(&home, &[0.0; 4], None),
        "q0 has 4 values, and 5 are needed"
    );
    assert_eq!(
        said(&home, &[f64::NAN; 5], None),
        "q0 holds NaN or infinity"
    );
    let nan = home.map(|it| it * f64::NAN);
    assert_eq!(said(&nan, &q0, None), "the target holds NaN or infinity");
    for mask in [[0.0; 6], [-1.0, 1.0, 1.0, 0.0, 0.0, 0.0], [f64::NAN; 6]] {
        let said = said(&home, &q0, Some(mask));
        assert!(
            said.starts_with("mask ") && said.contains("at least one is above 0"),
            "{said}"
        );
    }
    let stretched = home * 1.01;
    assert!(said(&stretched, &q0, None).starts_with("the target is no pose: its last row"));
    let skewed =
        home + Matrix4::from_fn(|row, column| if (row, column) == (0, 1) { 0.1 } else { 0.0 });
    assert!(said(&skewed, &q0, None).contains("not at right angles"));
    let mut mirror = Matrix4::identity();
    mirror[(2, 2)] = -1.0;
    assert_eq!(
        said(&mirror, &q0, None),
        "the target is no pose: its rotation is a mirror"
    );
}

#[test]
fn a_matrix_of_four_digits_is_a_pose() {
    let robot = create_so101_5dof();
    let pose = robot.fkine(&[0.3, 0.2, -0.5, 0.4, 0.1]).expect("a pose");
    let rounded = pose.to_homogeneous().map(|it| (it * 1e4).round() / 1e4);
    let made = pose_of(&rounded).expect("a pose");
    assert!(made.rotation.angle_to(&pose.rotation) < 1e-3);
    let (_, success, reason) = robot.ikine_lm(&rounded, None, Some([1.0, 1.0, 1.0, 1.0, 1.0, 0.0]));
    assert!(success, "{reason}");
    assert!(reason.starts_with("converged in "), "{reason}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever is asked: finite joint values within the limits, and a success that is one.
    #[test]
    fn every_target_has_an_answer(
        place in prop::array::uniform3(-2.0..2.0),
        turn in prop::array::uniform3(-3.2..3.2),
        q0 in prop::array::uniform5(-4.0..4.0),
        counted in prop::array::uniform6(any::<bool>()),
    ) {
        prop_assume!(counted.contains(&true));
        let robot = create_so101_5dof();
        let rotation = Rotation3::new(Vector3::from(turn));
        let target = IsometryMatrix3::from_parts(Vector3::from(place).into(), rotation);
        let weights = counted.map(|counts| if counts { 1.0 } else { 0.0 });
        let mask = Mask::new(weights).expect("weights");
        let solution = Solver::default().solve(&robot, &target, &q0, mask);
        let solution = solution.expect("a sound question");
        prop_assert!(is_within_limits(&robot, &solution.q));
        let left = error(&robot, &solution.q, &target, mask);
        let arrives = left.fixed_rows::<3>(0).norm() < 1.01e-6 && left.fixed_rows::<3>(3).norm() < 1.01e-6;
        prop_assert_eq!(solution.success(), arrives);
        let said = solution.remaining.position_m;
        prop_assert!((said - left.fixed_rows::<3>(0).norm()).abs() < 1e-9);
    }
}
