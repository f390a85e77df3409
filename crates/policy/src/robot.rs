//! The robot behind the PC link (docs/pc-link.md): its state frames become readings, and targets become command frames.

use robot_app::{
    domain::{JointTarget, WheelTarget},
    link::{Downlink, Uplink},
};

use crate::{
    Drive, PolicyDescription,
    action::Target,
    attitude::{NotAnAttitude, QuatXyzw},
    observation::Reading,
};

/// Motors of the link.
pub const MOTORS: usize = 6;
/// Motors that are wheels. They are the first.
const WHEELS: usize = 2;
/// Names of the motors in the link's order, as MJCF, URDF and `policy init` write them.
pub const MOTOR_NAMES: [&str; MOTORS] = [
    "left_wheel",
    "right_wheel",
    "left_front_hip",
    "left_rear_hip",
    "right_front_hip",
    "right_rear_hip",
];

/// Fastest rotation in rad/s that the gyro can measure, 2000°/s, and some more.
const GYRO_RPS: f32 = 40.0;
/// A joint beyond ±π reads ±π on the link, and no leg reaches that far.
const JOINT_RAD: f32 = std::f32::consts::PI - 1e-3;

/// Steps of the wheels' Kp, which has no effect on the robot. It changes with each frame, so that none is equal to the one
/// before: the robot takes a PC that repeats itself for a crashed one.
const COUNTER_STEPS: u16 = 256;
/// One step of a gain on the wire.
const GAIN_STEP: f32 = 1000.0 / 65_535.0;

/// A policy for another robot.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OtherRobot {
    /// It has not as many joints as the link has motors.
    #[error(
        "the policy has {found} joints, and the PC link has {MOTORS} motors: is it this robot's?"
    )]
    Joints {
        /// Joints of the policy.
        found: usize,
    },
    /// A wheel of the policy is a joint of the robot, or the other way round.
    #[error(
        "{joint} is motor {motor} of the PC link, {name}, which {is}: correct joint_mapping or wheel_indices; motors 0 and 1 \
         are the wheels"
    )]
    Kind {
        /// Name in the policy.
        joint: String,
        /// Number of the motor.
        motor: usize,
        /// Name of the motor.
        name: &'static str,
        /// What the motor is.
        is: &'static str,
    },
    /// The robot cannot do what the policy asks for.
    #[error("the policy asks for what the robot cannot do:{}", lines(.0))]
    Unfit(Vec<String>),
    /// The input holds the velocity of the body.
    #[error(
        "the policy observes lin_vel, and the robot does not measure it: train without this term"
    )]
    LinearVelocity,
}

/// A state frame with a value that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Implausible {
    /// No attitude.
    #[error("attitude: {0}")]
    Attitude(#[from] NotAnAttitude),
    /// A value that is NaN or beyond what its sensor can say.
    #[error("{what} is {value}, and the sensor says ±{most} at most")]
    Value {
        /// What it is of.
        what: String,
        /// The value.
        value: f32,
        /// Largest absolute value.
        most: f32,
    },
}

/// Translates between the link and a policy. Nothing is allocated after it was made.
#[derive(Clone, Debug)]
pub struct LinkRobot {
    policy: PolicyDescription,
    reading: Reading,
    counter: u16,
}

impl LinkRobot {
    /// Takes a policy for the robot behind the link.
    ///
    /// # Errors
    /// The policy has other joints or wheels than the link, or observes what the robot does not measure.
    pub fn new(policy: &PolicyDescription) -> Result<Self, OtherRobot> {
        let found = policy.joints.len();
        if found != MOTORS {
            return Err(OtherRobot::Joints { found });
        }
        for (joint, motor) in policy.joints.iter().zip(policy.mapping.motors()) {
            let is_wheel = *motor < WHEELS;
            if is_wheel != (joint.drive == Drive::Speed) {
                return Err(OtherRobot::Kind {
                    joint: joint.name.clone(),
                    motor: *motor,
                    name: MOTOR_NAMES[*motor],
                    is: if is_wheel {
                        "is a wheel"
                    } else {
                        "is no wheel"
                    },
                });
            }
        }
        if policy.needs_linear_velocity() {
            return Err(OtherRobot::LinearVelocity);
        }
        Ok(Self {
            policy: policy.clone(),
            reading: Reading::at_default_pose(policy),
            counter: 0,
        })
    }

    /// Returns the last reading, at first that of a level robot at its default pose.
    pub fn reading(&self) -> &Reading {
        &self.reading
    }

    /// Reads a state frame: order and sense of the joints become the policy's, and the quaternion x, y, z, w becomes
    /// w, x, y, z.
    ///
    /// # Errors
    /// A value is NaN or cannot be. Then the reading stays as it was.
    pub fn read(&mut self, state: &Uplink) -> Result<(), Implausible> {
        let attitude = QuatXyzw::new(state.q_xyzw)?;
        within(&state.gyro_rps, GYRO_RPS, |axis| {
            format!("gyro {}", ["x", "y", "z"][axis])
        })?;
        let angles = state.motors.map(|motor| motor.pos_rad);
        let speeds = state.motors.map(|motor| motor.vel_rps);
        let angle = |motor: usize| format!("angle of {}", MOTOR_NAMES[motor + WHEELS]);
        within(&angles[WHEELS..], JOINT_RAD, angle)?;
        within(&angles[..WHEELS], f32::MAX, |motor| {
            format!("angle of {}", MOTOR_NAMES[motor])
        })?;
        within(&speeds, f32::MAX, |motor| {
            format!("speed of {}", MOTOR_NAMES[motor])
        })?;
        let Self {
            policy, reading, ..
        } = self;
        reading.attitude = attitude.into();
        reading.body_rates_rps = state.gyro_rps;
        policy
            .mapping
            .policy_from_motors(&angles, &mut reading.joint_pos_rad);
        policy
            .mapping
            .policy_from_motors(&speeds, &mut reading.joint_vel_rps);
        Ok(())
    }

    /// Returns the frame for these targets. No two of them in a row are equal.
    ///
    /// # Panics
    /// There are not as many targets as joints.
    pub fn command(&mut self, targets: &[Target]) -> Downlink {
        let mut command = self.limp();
        let mapping = &self.policy.mapping;
        assert_eq!(targets.len(), mapping.motors().len());
        let placed = mapping.motors().iter().zip(mapping.directions());
        for (target, (motor, direction)) in targets.iter().zip(placed) {
            match *target {
                Target::Position { rad, kp, kd } => {
                    command.joints[*motor - WHEELS] = JointTarget {
                        pos_rad: direction * rad,
                        kp,
                        kd,
                    };
                }
                Target::Speed { rps, kd } => {
                    let wheel = &mut command.wheels[*motor];
                    wheel.speed_rps = direction * rps;
                    wheel.kd = kd;
                }
            }
        }
        command
    }

    /// Returns a frame with all gains 0: no motor has torque.
    pub fn limp(&mut self) -> Downlink {
        self.counter = (self.counter + 1) % COUNTER_STEPS;
        let wheel = WheelTarget {
            kp: f32::from(self.counter) * GAIN_STEP,
            ..WheelTarget::default()
        };
        Downlink {
            wheels: [wheel; WHEELS],
            joints: Default::default(),
        }
    }
}

/// Each on a line of its own.
fn lines(texts: &[String]) -> String {
    texts.iter().map(|text| format!("\n  {text}")).collect()
}

/// Refuses values beyond ±`most`, and NaN.
fn within(values: &[f32], most: f32, what: impl Fn(usize) -> String) -> Result<(), Implausible> {
    let wrong = values
        .iter()
        .position(|value| !(0.0..=most).contains(&value.abs()));
    wrong.map_or(Ok(()), |at| {
        Err(Implausible::Value {
            what: what(at),
            value: values[at],
            most,
        })
    })
}

#[cfg(test)]
mod tests;
