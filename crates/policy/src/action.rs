//! What the network's output means: targets of the motors, and their torque.

use crate::{ActionPlan, Drive, Joint, PolicyDescription};

/// An output that cannot be obeyed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ActionError {
    /// It has another length than the policy has joints.
    #[error("the network gives {found} actions, and the policy has {wanted} joints")]
    Count {
        /// Joints of the policy.
        wanted: usize,
        /// Values of the network.
        found: usize,
    },
    /// A value is infinite or NaN.
    #[error("the network's action for {joint} is {value}")]
    NotFinite {
        /// The joint.
        joint: String,
        /// Its value.
        value: f32,
    },
}

/// What a motor is told. Its torque is [`Target::torque_nm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A joint holds an angle.
    Position {
        /// Angle in rad.
        rad: f32,
        /// Stiffness in N·m/rad.
        kp: f32,
        /// Damping in N·m·s/rad.
        kd: f32,
    },
    /// A wheel keeps a speed.
    Speed {
        /// Speed in rad/s.
        rps: f32,
        /// Damping in N·m·s/rad.
        kd: f32,
    },
}

impl Target {
    /// Returns the torque in N·m that the motor gives at an angle and a speed: `kp · (target − angle) − kd · speed` of a
    /// joint, `kd · (target − speed)` of a wheel. No limit is applied.
    pub fn torque_nm(self, angle_rad: f32, speed_rps: f32) -> f32 {
        match self {
            Self::Position { rad, kp, kd } => kp * (rad - angle_rad) - kd * speed_rps,
            Self::Speed { rps, kd } => kd * (rps - speed_rps),
        }
    }

    /// Returns the target with which the motor's torque is the former one held within ±`limit_nm`, at this angle and speed:
    /// `clamp(target, angle + (kd · speed ± limit) / kp)` of a joint, `clamp(target, speed ± limit / kd)` of a wheel.
    ///
    /// A joint without stiffness, and a wheel without damping, keep their target: it has no effect on the torque.
    #[must_use]
    pub fn within_torque(self, limit_nm: f32, angle_rad: f32, speed_rps: f32) -> Self {
        match self {
            Self::Position { rad, kp, kd } if kp > 0.0 => {
                let [middle_rad, reach_rad] = [angle_rad + kd * speed_rps / kp, limit_nm / kp];
                let rad = rad.max(middle_rad - reach_rad).min(middle_rad + reach_rad);
                Self::Position { rad, kp, kd }
            }
            Self::Speed { rps, kd } if kd > 0.0 => {
                let reach_rps = limit_nm / kd;
                let rps = rps.max(speed_rps - reach_rps).min(speed_rps + reach_rps);
                Self::Speed { rps, kd }
            }
            same => same,
        }
    }
}

/// Turns the network's output into targets.
#[derive(Clone, Debug)]
pub struct Decoder {
    joints: Vec<Joint>,
    last_actions: Vec<f32>,
    targets: Vec<Target>,
}

impl Decoder {
    /// Returns a decoder whose last actions are 0.
    pub fn new(policy: &PolicyDescription) -> Self {
        let mut decoder = Self {
            joints: policy.joints.clone(),
            last_actions: vec![0.0; policy.joints.len()],
            targets: Vec::with_capacity(policy.joints.len()),
        };
        decoder.reset();
        decoder
    }

    /// Forgets the last actions: they are 0. It belongs to every start of the policy.
    pub fn reset(&mut self) {
        self.last_actions.fill(0.0);
        self.targets.clear();
        self.targets
            .extend(self.joints.iter().map(|joint| target(joint, 0.0)));
    }

    /// Returns the last actions, clipped and not scaled, as the next observation has them.
    pub fn last_actions(&self) -> &[f32] {
        &self.last_actions
    }

    /// Returns the targets, in the policy's order and sense. The torque limits are not applied: see
    /// [`Target::within_torque`].
    ///
    /// # Errors
    /// The output has another length, or a value that is no number. Then nothing is changed.
    pub fn decode(&mut self, output: &[f32]) -> Result<&[Target], ActionError> {
        if output.len() != self.joints.len() {
            return Err(ActionError::Count {
                wanted: self.joints.len(),
                found: output.len(),
            });
        }
        let mut pairs = self.joints.iter().zip(output);
        if let Some((joint, value)) = pairs.find(|(_, value)| !value.is_finite()) {
            return Err(ActionError::NotFinite {
                joint: joint.name.clone(),
                value: *value,
            });
        }
        self.targets.clear();
        for ((joint, value), last) in self.joints.iter().zip(output).zip(&mut self.last_actions) {
            *last = clamp(*value, joint.action.clip);
            self.targets.push(target(joint, *last));
        }
        Ok(&self.targets)
    }
}

/// The target of a clipped action.
fn target(joint: &Joint, action: f32) -> Target {
    let ActionPlan {
        scale,
        offset,
        target_range,
        ..
    } = joint.action;
    let value = clamp(action * scale + offset, target_range);
    match joint.drive {
        Drive::Position => Target::Position {
            rad: value,
            kp: joint.kp,
            kd: joint.kd,
        },
        Drive::Speed => Target::Speed {
            rps: value,
            kd: joint.kd,
        },
    }
}

fn clamp(value: f32, [low, high]: [f32; 2]) -> f32 {
    value.clamp(low, high)
}
