//! Poses that can be reached.

use nalgebra::{IsometryMatrix3, Translation3};
use robot_arm::{
    ik::{Mask, Solver},
    kinematics::{Robot, create_so101_5dof},
};
use robot_test_support::Random;

use crate::{
    arms,
    judge::{any_values, error, is_within_limits},
};

/// Asks for poses of random joint values, from other random ones. Returns how many were solved, and checks these.
fn solved(robot: &Robot, mask: Mask, poses: usize) -> usize {
    let mut random = Random::new(1616);
    let mut solved = 0;
    for _ in 0..poses {
        let target = robot
            .fkine(&any_values(robot, &mut random))
            .expect("a pose");
        let q0 = any_values(robot, &mut random);
        let solution = Solver::default().solve(robot, &target, &q0, mask);
        let solution = solution.expect("a sound question");
        assert!(is_within_limits(robot, &solution.q), "{solution:?}");
        if solution.success() {
            let left = error(robot, &solution.q, &target, mask);
            assert!(left.fixed_rows::<3>(0).norm() < 1.01e-6, "{left}");
            assert!(left.fixed_rows::<3>(3).norm() < 1.01e-6, "{left}");
            solved += 1;
        }
    }
    solved
}

#[test]
fn the_so101_reaches_what_it_can_reach() {
    let robot = create_so101_5dof();
    for mask in [Mask::POSE, Mask::WITHOUT_YAW, Mask::POSITION] {
        let solved = solved(&robot, mask, 3000);
        assert!(solved >= 2997, "{solved} with {mask:?}");
    }
}

#[test]
fn arms_of_six_and_seven_joints_reach_what_they_can_reach() {
    for robot in [arms::puma560(), arms::stanford(), arms::panda()] {
        let solved = solved(&robot, Mask::POSE, 500);
        assert!(solved >= 499, "{solved} by {}", robot.name());
    }
}

#[test]
fn weights_of_other_sizes_ask_for_the_same() {
    let robot = create_so101_5dof();
    let mask = Mask::new([2.0, 0.5, 1.0, 0.1, 0.1, 0.0]).expect("weights");
    assert!(solved(&robot, mask, 300) >= 299);
}

#[test]
fn equal_seeds_give_equal_answers() {
    let robot = create_so101_5dof();
    let target = robot.fkine(&[1.8, -1.7, 1.6, -1.6, 2.7]).expect("a pose");
    let q = |seed| {
        let solver = Solver {
            seed,
            ..Solver::default()
        };
        let solution = solver.solve(
            &robot,
            &target,
            &[-1.9, 1.7, -1.6, 1.6, -2.7],
            Mask::POSITION,
        );
        solution.expect("a sound question").q
    };
    assert_eq!(q(3), q(3));
}

/// A base and a tool of another robot's cell change the numbers, not what can be done.
#[test]
fn base_and_tool_take_part() {
    let mut robot = create_so101_5dof();
    let moved =
        |x, y, z| IsometryMatrix3::from_parts(Translation3::new(x, y, z), Default::default());
    robot.set_base(moved(2.0, -1.0, 0.7)).expect("finite");
    robot.set_tool(moved(0.0, 0.0, 0.08)).expect("finite");
    assert!(solved(&robot, Mask::POSE, 200) >= 199);
}

/// Straight up, straight out and at the target already: where columns of the Jacobian are parallel or the error is 0.
#[test]
fn singular_poses_are_solved_without_nan() {
    let robot = create_so101_5dof();
    let lengths = [
        [0.0; 5],
        [0.0, -1.0, 1.0, 0.0, 0.0],
        [0.7, 0.2, -1.4, 0.0, 1.0],
    ];
    for q in lengths {
        let target = robot.fkine(&q).expect("a pose");
        for q0 in [q, [0.0; 5]] {
            let solution = Solver::default().solve(&robot, &target, &q0, Mask::POSE);
            assert!(
                solution.expect("a sound question").success(),
                "{q:?} from {q0:?}"
            );
        }
    }
}
