//! Whether the numbers of a policy are within what the robot can do.

use std::ops::RangeInclusive;

use robot_description::Robot;

use crate::{Drive, Joint, PolicyDescription, limits::Limits, robot::MOTOR_NAMES};

/// Periods in s of the control loop that the link can carry: a command takes 0.8 ms, and after 0.1 s without one the robot
/// takes its PC for lost.
const PERIODS_S: RangeInclusive<f32> = 0.001..=0.05;

/// Something in which policy and robot differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Index of the joint in the policy; `None` if it is of all of them.
    pub joint: Option<usize>,
    /// What is wrong, and the cure.
    pub text: String,
    /// The policy cannot be run. Otherwise it is worth a look.
    pub is_error: bool,
}

/// Compares a policy with the description of its robot, whose `wheels.current_limit_a` is what the wheels may have now.
pub fn faults(policy: &PolicyDescription, robot: &Robot) -> Vec<Fault> {
    let mut faults = Vec::new();
    if !PERIODS_S.contains(&policy.control_period_s) {
        faults.push(Fault {
            joint: None,
            text: format!(
                "dt is {} s, and the PC link takes a command each {} to {} s: change dt and decimation, and leave their product \
                 as trained",
                policy.control_period_s,
                PERIODS_S.start(),
                PERIODS_S.end()
            ),
            is_error: true,
        });
    }
    let limits = Limits::new(policy, robot);
    for (index, joint) in policy.joints.iter().enumerate() {
        let motor = policy.mapping.motors()[index];
        let mut add = |is_error, text: Option<String>| {
            faults.extend(text.map(|text| Fault {
                joint: Some(index),
                text,
                is_error,
            }));
        };
        add(true, other_motors_name(joint, motor));
        add(true, limits.range_rad(index).and_then(|it| pose(joint, it)));
        if joint.drive == Drive::Position {
            add(true, gains(joint, robot));
        }
        add(false, torque(joint, robot));
    }
    faults
}

/// Trainers may have names of their own, but those of another motor are a mistake.
fn other_motors_name(joint: &Joint, motor: usize) -> Option<String> {
    let name = *MOTOR_NAMES.get(motor)?;
    let is_other = joint.name != name && MOTOR_NAMES.contains(&joint.name.as_str());
    is_other.then(|| format!("motor {motor} is {name}: correct joint_names or joint_mapping"))
}

fn pose(joint: &Joint, [low, high]: [f32; 2]) -> Option<String> {
    let is_outside = !(low..=high).contains(&joint.default_rad);
    is_outside.then(|| {
        format!("its default is outside of {low:+.2} to {high:+.2}: correct default_dof_pos or joint_directions")
    })
}

fn gains(joint: &Joint, robot: &Robot) -> Option<String> {
    let most = [robot.joints.max_kp as f32, robot.joints.max_kd as f32];
    let gains = [
        ("rl_kp", joint.kp, most[0]),
        ("rl_kd", joint.kd, most[1]),
        ("fixed_kp", joint.fixed_kp, most[0]),
        ("fixed_kd", joint.fixed_kd, most[1]),
    ];
    let (key, gain, most) = gains.into_iter().find(|(_, gain, most)| gain > most)?;
    Some(format!(
        "{key} is {gain}, and its motor takes {most} at most: the robot would be softer than in training"
    ))
}

fn torque(joint: &Joint, robot: &Robot) -> Option<String> {
    let limit_nm = joint.torque_limit_nm;
    let is_beyond = |most_nm: f64| limit_nm > 1.001 * most_nm as f32;
    let beyond = |most_nm: f64| {
        format!("torque_limits has {limit_nm} N·m, and the robot gives {most_nm:.1}")
    };
    let wheels = &robot.wheels;
    let [delivered_nm, most_nm] = match joint.drive {
        Drive::Position => [robot.joints.torque_limit_nm; 2],
        Drive::Speed => {
            [wheels.current_limit_a, wheels.max_current_a].map(|it| it * wheels.torque_nm_per_a)
        }
    };
    if is_beyond(most_nm) {
        Some(format!(
            "{}, never more than {most_nm:.1}",
            beyond(delivered_nm)
        ))
    } else if is_beyond(delivered_nm) {
        let wanted_ma = 1e3 * f64::from(limit_nm) / wheels.torque_nm_per_a;
        let cure = format!(
            "robotctl tune --can can0 set wheel-controller.current-limit-ma {wanted_ma:.0}"
        );
        Some(format!("{}: `{cure}`", beyond(delivered_nm)))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{JointMapping, runner::testing};

    fn found(change: impl Fn(&mut PolicyDescription)) -> Vec<Fault> {
        let mut policy = testing::policy();
        change(&mut policy);
        let mut faults = faults(&policy, &testing::robot());
        faults.retain(|fault| fault.is_error);
        faults
    }

    #[test]
    fn what_the_robot_cannot_do_is_named_with_its_joint() {
        assert_eq!(found(|_| {}), []);
        for (joint, part, change) in [
            (
                Some(0),
                "default is outside of -1.35 to +0.75",
                (|it| it.joints[0].default_rad = 0.9) as fn(&mut PolicyDescription),
            ),
            (Some(1), "rl_kp is 150", |it| it.joints[1].kp = 150.0),
            (Some(2), "rl_kd is 5.5", |it| it.joints[2].kd = 5.5),
            (Some(3), "fixed_kp is 101", |it| {
                it.joints[3].fixed_kp = 101.0;
            }),
            (None, "dt is 0.0005 s", |it| it.control_period_s = 0.0005),
            (None, "dt is 0.1 s", |it| it.control_period_s = 0.1),
        ] {
            let faults = found(change);
            assert_eq!(faults.len(), 1, "{faults:?}");
            assert_eq!(faults[0].joint, joint, "{faults:?}");
            assert!(faults[0].text.contains(part), "{faults:?}");
        }
    }

    #[test]
    fn names_of_other_motors_are_errors_and_names_of_the_trainers_own_are_not() {
        let swapped = found(|it| {
            it.mapping = JointMapping::new(vec![3, 2, 4, 5, 0, 1], &[1; 6]).expect("a mapping");
        });
        assert_eq!(swapped.len(), 2, "{swapped:?}");
        assert!(swapped[0].text.contains("motor 3 is left_rear_hip"));
        let own = found(|it| it.joints[0].name = "FL_hip_joint".to_owned());
        assert_eq!(own, []);
    }

    #[test]
    fn a_torque_that_the_robot_does_not_give_is_worth_a_look() {
        let delivered = "and the robot gives";
        for (joint, limit_nm, text) in [
            (0, 10.0, "5.0, never more than 5.0"),
            (4, 10.0, "2.4, never more than 4.5"),
            (
                4,
                4.5,
                "2.4: `robotctl tune --can can0 set wheel-controller.current-limit-ma 15000`",
            ),
        ] {
            let mut policy = testing::policy();
            policy.joints[joint].torque_limit_nm = limit_nm;
            let faults = faults(&policy, &testing::robot());
            let of_joint = faults.iter().find(|it| it.joint == Some(joint));
            let text = format!("torque_limits has {limit_nm} N·m, {delivered} {text}");
            assert_eq!(
                of_joint.map(|it| (it.text.as_str(), it.is_error)),
                Some((text.as_str(), false))
            );
        }
    }
}
