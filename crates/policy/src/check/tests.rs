use super::*;
use crate::{JointMapping, runner::testing};

#[test]
fn a_swapped_mapping_is_an_error_of_its_joints() {
    let mut policy = testing::policy();
    let reading = Reading::at_default_pose(&policy);
    let errors = |policy: &PolicyDescription| {
        let rows = rows(policy, &testing::robot(), &reading);
        rows.iter().map(|row| row.errors.len()).collect::<Vec<_>>()
    };
    assert_eq!(errors(&policy), [0; 6]);
    policy.mapping = JointMapping::new(vec![3, 2, 4, 5, 0, 1], &[1; 6]).unwrap();
    assert_eq!(errors(&policy), [1, 1, 0, 0, 0, 0]);
}

#[test]
fn a_default_outside_of_the_range_is_an_error_and_a_far_joint_a_hint() {
    let mut policy = testing::policy();
    let mut reading = Reading::at_default_pose(&policy);
    policy.joints[0].default_rad = 0.9;
    reading.joint_pos_rad[1] = 1.3;
    reading.joint_pos_rad[2] = 0.8;
    let rows = rows(&policy, &testing::robot(), &reading);
    let has = |row: &Row, part| row.hints.iter().any(|hint| hint.contains(part));
    assert!(
        rows[0].errors[0].contains("its default is outside of -1.35 to +0.75"),
        "{rows:?}"
    );
    assert!(
        rows[1].errors.is_empty() && has(&rows[1], "more than 1 rad"),
        "{rows:?}"
    );
    assert!(has(&rows[2], "is its zero right?"), "{rows:?}");
}

#[test]
fn the_joint_that_a_hand_turns_is_named_with_its_sign() {
    let mut policy = testing::policy();
    // The policy counts the left rear hip the other way round.
    policy.mapping = JointMapping::new(vec![2, 3, 4, 5, 0, 1], &[1, -1, 1, 1, 1, 1]).unwrap();
    let mut turns = HandTurns::new(&policy);
    let mut reading = Reading::at_default_pose(&policy);
    assert_eq!(turns.take(&reading), None);
    let mut turned = |joint: usize, by_rad: f32| {
        reading.joint_pos_rad[joint] += by_rad;
        // The leg moves its other joint a little.
        reading.joint_pos_rad[(joint + 1) % 6] += 0.05;
        let turned = turns.take(&reading).expect("it is turned");
        assert_eq!(turned.joint, joint);
        assert!((turned.by_rad - by_rad).abs() < 0.06, "{turned:?}");
        turned.seen
    };
    assert_eq!(turned(0, 0.3), "the thigh went up");
    assert_eq!(turned(1, 0.3), "the thigh went up");
    assert_eq!(turned(3, 0.3), "the thigh went down");
    assert_eq!(turned(4, -0.3), "the wheel rolled backward");
}

#[test]
fn a_wheels_angle_may_wrap() {
    let policy = testing::policy();
    let mut turns = HandTurns::new(&policy);
    let mut reading = Reading::at_default_pose(&policy);
    reading.joint_pos_rad[5] = 3.1;
    turns.take(&reading);
    reading.joint_pos_rad[5] = -3.0;
    assert_eq!(turns.take(&reading), None, "0.18 rad");
    reading.joint_pos_rad[5] = -2.8;
    let turned = turns.take(&reading).expect("it is turned");
    assert_eq!((turned.joint, turned.seen), (5, "the wheel rolled forward"));
}
