//! Compares a policy's joints with the robot's: order, sense, default pose. The robot is switched on and has no torque.

use std::f32::consts::{PI, TAU};

use robot_description::Robot;

use crate::{
    Drive, PolicyDescription, fit, limits::Limits, observation::Reading, robot::MOTOR_NAMES,
};

/// A joint that a hand has turned by so much in rad counts as turned.
const TURNED_RAD: f32 = 0.2;
/// A joint further than this in rad from its default angle is worth a look: getting up moves it so far.
const FAR_RAD: f32 = 1.0;

/// A joint of a policy beside the motor that it is mapped to.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name in the policy.
    pub joint: String,
    /// Number of the motor on the PC link.
    pub motor: usize,
    /// Name of that motor.
    pub motor_name: &'static str,
    /// Whether the policy counts the other way round.
    pub is_reversed: bool,
    /// Default angle in rad; a wheel has none.
    pub default_rad: Option<f32>,
    /// Range in rad in the policy's sense; a wheel has none.
    pub range_rad: Option<[f32; 2]>,
    /// Measured angle in rad.
    pub measured_rad: f32,
    /// What is wrong with the policy's files.
    pub errors: Vec<String>,
    /// What is worth a look.
    pub hints: Vec<String>,
}

/// Returns a row for each joint of the policy, in its order.
pub fn rows(policy: &PolicyDescription, robot: &Robot, reading: &Reading) -> Vec<Row> {
    let limits = Limits::new(policy, robot);
    let placed = policy
        .mapping
        .motors()
        .iter()
        .zip(policy.mapping.directions());
    let joints = policy.joints.iter().zip(placed).enumerate();
    let faults = fit::faults(policy, robot);
    let rows = joints.map(|(index, (joint, (motor, direction)))| {
        let default_rad = (joint.drive == Drive::Position).then_some(joint.default_rad);
        let mut row = Row {
            joint: joint.name.clone(),
            motor: *motor,
            motor_name: MOTOR_NAMES[*motor],
            is_reversed: *direction < 0.0,
            default_rad,
            range_rad: limits.range_rad(index),
            measured_rad: reading.joint_pos_rad[index],
            errors: Vec::new(),
            hints: Vec::new(),
        };
        for fault in faults.iter().filter(|it| it.joint == Some(index)) {
            let list = if fault.is_error {
                &mut row.errors
            } else {
                &mut row.hints
            };
            list.push(fault.text.clone());
        }
        row.judge();
        row
    });
    rows.collect()
}

impl Row {
    fn judge(&mut self) {
        if !MOTOR_NAMES.contains(&self.joint.as_str()) {
            self.hints.push(format!(
                "its name is not the robot's: is it {}?",
                self.motor_name
            ));
        }
        let (Some(default_rad), Some([low, high])) = (self.default_rad, self.range_rad) else {
            return;
        };
        let range = low..=high;
        if !range.contains(&self.measured_rad) {
            self.hints.push(format!(
                "it is outside of {low:+.2} to {high:+.2}: is its zero right?"
            ));
        } else if (self.measured_rad - default_rad).abs() > FAR_RAD {
            self.hints
                .push("getting up moves it by more than 1 rad".to_owned());
        }
    }
}

/// A joint that a hand has turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Turned {
    /// Index in the policy.
    pub joint: usize,
    /// Change in rad, in the policy's sense.
    pub by_rad: f32,
    /// What the part did, by the robot's own sense.
    pub seen: &'static str,
}

/// Finds the joint that a hand turns: the one that has moved most since the last was found.
#[derive(Clone, Debug)]
pub struct HandTurns {
    motors: Vec<usize>,
    directions: Vec<f32>,
    from_rad: Option<Vec<f32>>,
}

impl HandTurns {
    /// Returns a watch on a policy's joints.
    pub fn new(policy: &PolicyDescription) -> Self {
        Self {
            motors: policy.mapping.motors().to_vec(),
            directions: policy.mapping.directions().to_vec(),
            from_rad: None,
        }
    }

    /// Takes a reading. The first one says where the joints are.
    pub fn take(&mut self, reading: &Reading) -> Option<Turned> {
        let now_rad = &reading.joint_pos_rad;
        let from_rad = self.from_rad.get_or_insert_with(|| now_rad.clone());
        let changes = now_rad
            .iter()
            .zip(from_rad.iter())
            .map(|(now, from)| wrapped(now - from));
        let most = changes
            .enumerate()
            .max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
        let (joint, by_rad) = most.filter(|(_, by_rad)| by_rad.abs() > TURNED_RAD)?;
        from_rad.clone_from(now_rad);
        Some(Turned {
            joint,
            by_rad,
            seen: seen(self.motors[joint], self.directions[joint] * by_rad > 0.0),
        })
    }
}

/// What a part does as its motor's angle grows or falls (docs/motors.md).
fn seen(motor: usize, grows: bool) -> &'static str {
    let name = MOTOR_NAMES[motor];
    match (name.contains("wheel"), name.contains("front"), grows) {
        (true, _, true) => "the wheel rolled forward",
        (true, _, false) => "the wheel rolled backward",
        (false, true, true) | (false, false, false) => "the thigh went up",
        (false, true, false) | (false, false, true) => "the thigh went down",
    }
}

/// The same angle within ±π: that of a wheel wraps.
fn wrapped(rad: f32) -> f32 {
    (rad + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests;
