//! Draws questions, and judges answers without the solver.

use nalgebra::{IsometryMatrix3, UnitQuaternion, Vector6};
use robot_arm::{ik::Mask, kinematics::Robot};
use robot_test_support::Random;

/// Joint values within the limits, and within a turn.
pub fn any_values(robot: &Robot, random: &mut Random) -> Vec<f64> {
    let joints = robot.joints().iter();
    joints
        .map(|joint| random.between(joint.lower().max(-3.1), joint.upper().min(3.1)))
        .collect()
}

/// The error in the parts that the mask counts, by nalgebra's logarithm of a quaternion.
pub fn error(robot: &Robot, q: &[f64], target: &IsometryMatrix3<f64>, mask: Mask) -> Vector6<f64> {
    let pose = robot.fkine(q).expect("a pose");
    let place = target.translation.vector - pose.translation.vector;
    let turn = target.rotation * pose.rotation.inverse();
    // Rotations of nalgebra lose half of the digits of a small angle, quaternions none.
    let turn = UnitQuaternion::from_rotation_matrix(&turn).scaled_axis();
    let all = Vector6::new(place.x, place.y, place.z, turn.x, turn.y, turn.z);
    let counts = mask.weights().map(|weight| f64::from(weight > 0.0));
    all.component_mul(&Vector6::from(counts))
}

pub fn is_within_limits(robot: &Robot, q: &[f64]) -> bool {
    let mut pairs = robot.joints().iter().zip(q);
    pairs.all(|(joint, q)| (joint.lower()..=joint.upper()).contains(q))
}
