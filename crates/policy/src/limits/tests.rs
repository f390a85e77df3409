use super::*;
use crate::{JointMapping, runner::testing};

#[test]
fn ranges_are_the_robots_in_the_policys_sense() {
    let mut policy = testing::policy();
    policy.mapping = JointMapping::new(vec![2, 3, 4, 5, 0, 1], &[1, -1, -1, 1, 1, 1]).unwrap();
    let limits = Limits::new(&policy, &testing::robot());
    let front = [-1.35, 0.75];
    let rear = [-0.75, 1.35];
    let ranges: Vec<_> = (0..6).map(|joint| limits.range_rad(joint)).collect();
    assert_eq!(
        ranges,
        [
            Some(front),
            Some([-1.35, 0.75]),
            Some([-0.75, 1.35]),
            Some(rear),
            None,
            None
        ]
    );
}

#[test]
fn a_stop_names_the_joint_the_value_and_a_cure() {
    let policy = testing::policy();
    let limits = Limits::new(&policy, &testing::robot());
    let mut reading = Reading::at_default_pose(&policy);
    reading.joint_pos_rad[2] = 0.9;
    let stop = limits.check_positions(&reading).unwrap_err();
    let said = stop.to_string();
    assert!(
        said.starts_with("right_front_hip is at +0.900 rad, outside of -1.350 to +0.750"),
        "{said}"
    );
    assert!(said.contains("policy check"), "{said}");
}

#[test]
fn a_joint_may_press_its_stop() {
    let policy = testing::policy();
    let limits = Limits::new(&policy, &testing::robot());
    let mut reading = Reading::at_default_pose(&policy);
    for (rad, holds) in [(0.84, true), (0.86, false), (-1.44, true), (-1.46, false)] {
        reading.joint_pos_rad[2] = rad;
        assert_eq!(limits.check_positions(&reading).is_ok(), holds, "{rad}");
    }
}

#[test]
fn stops_have_names_of_their_own() {
    let joint = || "left_wheel".to_owned();
    let stops = [
        Stop::Asked,
        Stop::TimeOver { seconds: 1.0 },
        Stop::NotPermitted(Obstacle::RadioLost),
        Stop::Position {
            joint: joint(),
            rad: 0.0,
            low: 0.0,
            high: 0.0,
        },
        Stop::Speed {
            joint: joint(),
            rps: 0.0,
            most: 0.0,
        },
        Stop::Torque {
            joint: joint(),
            nm: 0.0,
            most: 0.0,
        },
        Stop::Attitude {
            degrees: 0.0,
            most: 0.0,
        },
        Stop::Stale { age_s: 0.0 },
        Stop::Network(String::new()),
        Stop::Deadline {
            late_ms: 0.0,
            misses: 0,
        },
        Stop::NoCommands(String::new()),
        Stop::LinkFailed(String::new()),
    ];
    let mut names: Vec<_> = stops.iter().map(Stop::name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), stops.len());
}
