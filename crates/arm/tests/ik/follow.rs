//! Control in real time: bounded steps.

use nalgebra::Translation3;
use proptest::prelude::*;
use robot_arm::{
    ik::{IkError, Mask, Outcome, Solver},
    kinematics::{Robot, create_so101_5dof},
};
use robot_test_support::Random;

use crate::judge::{any_values, error, is_within_limits};

/// A square of 6 cm in front of the arm, 2 mm a call.
#[test]
fn a_path_is_followed_without_a_jump() {
    let robot = create_so101_5dof();
    let mut q = vec![0.0, -0.6, 0.8, 0.6, 0.0];
    let start = robot.fkine(&q).expect("a pose");
    let sides = [
        [0.0, 0.0, 0.002],
        [0.0, 0.002, 0.0],
        [0.0, 0.0, -0.002],
        [0.0, -0.002, 0.0],
    ];
    let mut target = start;
    for step in sides.iter().flat_map(|side| std::iter::repeat_n(side, 30)) {
        target = Translation3::from(*step) * target;
        let solution = Solver::default().follow(&robot, &target, &q, Mask::WITHOUT_YAW, 0.05);
        let solution = solution.expect("a sound question");
        assert!(solution.success(), "{}", solution.reason());
        let change = q
            .iter()
            .zip(&solution.q)
            .map(|(old, new)| (old - new).abs());
        let change = change.fold(0.0, f64::max);
        assert!(change < 0.04, "{change}");
        q = solution.q;
    }
    assert!(error(&robot, &q, &start, Mask::WITHOUT_YAW).norm() < 2e-6);
}

#[test]
fn a_far_target_is_reached_in_steps() {
    let robot = create_so101_5dof();
    let mut random = Random::new(5);
    let mut arrived = 0;
    for _ in 0..100 {
        let target = robot
            .fkine(&any_values(&robot, &mut random))
            .expect("a pose");
        let mut q = vec![0.0; 5];
        for _ in 0..60 {
            let solution = Solver::default().follow(&robot, &target, &q, Mask::POSITION, 0.1);
            let solution = solution.expect("a sound question");
            q = solution.q;
            if solution.outcome != Outcome::OnTheWay {
                arrived += usize::from(solution.outcome == Outcome::Converged);
                break;
            }
        }
    }
    assert!(
        arrived >= 80,
        "{arrived} of 100: some have a limit in the way"
    );
}

/// What is said to be out of reach must be: small moves within the limits all arrive, whichever joints they need.
#[test]
fn every_small_move_arrives() {
    let robot = create_so101_5dof();
    let mut random = Random::new(16);
    for mask in [Mask::POSE, Mask::WITHOUT_YAW, Mask::POSITION] {
        for largest_change in [0.003, 0.03, 0.1] {
            let arrived = (0..1000)
                .filter(|_| small_move_arrives(&robot, mask, largest_change, &mut random))
                .count();
            assert!(
                arrived >= 997,
                "{arrived} of 1000 with {mask:?}, {largest_change} rad a call"
            );
        }
    }
}

/// Asks for a pose of joint values that are up to three calls away.
fn small_move_arrives(robot: &Robot, mask: Mask, largest_change: f64, random: &mut Random) -> bool {
    let mut q = any_values(robot, random);
    let joints = robot.joints().iter().zip(&q);
    let goal: Vec<f64> = joints
        .map(|(joint, q)| {
            let goal = q + 3.0 * largest_change * random.between(-1.0, 1.0);
            goal.clamp(joint.lower(), joint.upper())
        })
        .collect();
    let target = robot.fkine(&goal).expect("a pose");
    for _ in 0..20 {
        let solution = Solver::default().follow(robot, &target, &q, mask, largest_change);
        let solution = solution.expect("a sound question");
        q = solution.q;
        if solution.outcome != Outcome::OnTheWay {
            return solution.outcome == Outcome::Converged;
        }
    }
    false
}

#[test]
fn a_joint_that_was_pushed_beyond_its_limit_comes_back_step_by_step() {
    let robot = create_so101_5dof();
    let target = robot.fkine(&[0.0; 5]).expect("a pose");
    let beyond = [2.5, 0.0, 0.0, 0.0, 0.0];
    let solution = Solver::default().follow(&robot, &target, &beyond, Mask::POSITION, 0.1);
    let solution = solution.expect("a sound question");
    assert!((solution.q[0] - 2.4).abs() < 1e-12, "{solution:?}");
    assert_eq!(solution.outcome, Outcome::OnTheWay);
    assert!(solution.reason().starts_with("on the way: "));
}

#[test]
fn a_change_that_is_none_is_refused() {
    let robot = create_so101_5dof();
    let target = robot.fkine(&[0.0; 5]).expect("a pose");
    for change in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let answer = Solver::default().follow(&robot, &target, &[0.0; 5], Mask::POSE, change);
        assert!(matches!(answer, Err(IkError::Change(_))));
    }
}

proptest! {
    #[test]
    fn no_joint_moves_further_than_allowed_and_the_tool_comes_no_further_away(
        goal in prop::array::uniform5(-4.0..4.0),
        seed: u64,
        largest_change in 1e-4..1.0,
    ) {
        let robot = create_so101_5dof();
        let q = any_values(&robot, &mut Random::new(seed));
        let target = robot.fkine(&goal).expect("a pose");
        let solution = Solver::default().follow(&robot, &target, &q, Mask::POSE, largest_change);
        let solution = solution.expect("a sound question");
        prop_assert!(is_within_limits(&robot, &solution.q));
        for (old, new) in q.iter().zip(&solution.q) {
            prop_assert!((old - new).abs() <= largest_change * (1.0 + 1e-12));
        }
        let [before, after] = [&q, &solution.q].map(|q| error(&robot, q, &target, Mask::POSE).norm());
        prop_assert!(after <= before + 1e-9);
    }
}
