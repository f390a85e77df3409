//! What a policy is: its joints, its input, its output.

use crate::JointMapping;

/// What the values of a network's input and output are, whichever file said so.
///
/// All lists of joints are in the policy's order and sense.
#[derive(Clone, Debug, PartialEq)]
pub struct PolicyDescription {
    /// Name, such as `fivebar/flat`.
    pub name: String,
    /// File of the network, beside the configuration.
    pub model_file: String,
    /// Period in s of the control loop.
    pub control_period_s: f32,
    /// Periods of the control loop from one run of the network to the next.
    pub decimation: u32,
    /// The joints, wheels included.
    pub joints: Vec<Joint>,
    /// Which motor is which joint.
    pub mapping: JointMapping,
    /// What the input holds, one group after another.
    pub observation: Vec<Group>,
    /// Range of the commands forward in m/s, left in m/s and of turning left in rad/s. Commands are held within it.
    pub command_ranges: [[f32; 2]; 3],
}

impl PolicyDescription {
    /// Returns the time in s from one run of the network to the next: `control_period_s · decimation`.
    pub fn period_s(&self) -> f64 {
        f64::from(self.control_period_s) * f64::from(self.decimation)
    }

    /// Returns the number of wheels.
    pub(crate) fn wheel_count(&self) -> usize {
        let wheels = self.joints.iter();
        wheels.filter(|joint| joint.drive == Drive::Speed).count()
    }

    /// Returns whether the input holds the body's velocity, which only a simulator knows.
    pub fn needs_linear_velocity(&self) -> bool {
        let mut terms = self.observation.iter().flat_map(|group| &group.terms);
        terms.any(|term| term.source == Source::LinearVelocity)
    }
}

/// A joint, or a wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// What its target is.
    pub drive: Drive,
    /// Angle in rad that counts as 0 in observations and actions. Of a wheel it has no meaning.
    pub default_rad: f32,
    /// Stiffness in N·m/rad while the policy drives. That of a wheel is 0.
    pub kp: f32,
    /// Damping in N·m·s/rad while the policy drives.
    pub kd: f32,
    /// Stiffness in N·m/rad while the robot gets up and down.
    pub fixed_kp: f32,
    /// Damping in N·m·s/rad while the robot gets up and down.
    pub fixed_kd: f32,
    /// Largest torque in N·m.
    pub torque_limit_nm: f32,
    /// How a value of the network becomes a target.
    pub action: ActionPlan,
}

/// What the target of a joint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// An angle.
    Position,
    /// A speed: it is a wheel.
    Speed,
}

/// How a value of the network becomes a target: `clamp(clamp(value, clip) · scale + offset, target_range)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActionPlan {
    /// Limits of the network's value. What is left is what the next observation has as `actions`.
    pub clip: [f32; 2],
    /// Unit of the target per unit of the network.
    pub scale: f32,
    /// Target in rad or rad/s of the value 0.
    pub offset: f32,
    /// Limits of the target in rad or rad/s.
    pub target_range: [f32; 2],
}

/// Terms with a common history.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The terms of one frame, in order.
    pub terms: Vec<TermPlan>,
    /// Ages of the frames, in order, in runs of the network. 0 is the frame of now.
    pub ages: Vec<usize>,
    /// What comes first, time or term.
    pub order: HistoryOrder,
}

/// How frames of several ages follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HistoryOrder {
    /// Frame after frame: all terms of the first age, then all of the second.
    Time,
    /// Term after term: all ages of the first term, then all of the second.
    Term,
}

/// A term of the observation: `clamp(scale · clamp(value, clip_before), clip_after)`.
#[derive(Clone, Debug, PartialEq)]
pub struct TermPlan {
    /// Name, as the file has it.
    pub name: String,
    /// What is observed.
    pub source: Source,
    /// Factor of each value.
    pub scale: Vec<f32>,
    /// Limits before the factor.
    pub clip_before: [f32; 2],
    /// Limits after it.
    pub clip_after: [f32; 2],
}

impl TermPlan {
    /// Returns the number of values in a frame.
    pub fn len(&self) -> usize {
        self.scale.len()
    }

    /// Returns whether it has no values, as `wheel_joint_vel` of a robot without wheels would.
    pub fn is_empty(&self) -> bool {
        self.scale.is_empty()
    }
}

/// What is observed. Vectors are in axes of the body: x forward, y left, z up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// Velocity of the body in m/s.
    LinearVelocity,
    /// Angular velocity of the body in rad/s.
    AngularVelocity,
    /// Direction of gravity, (0, 0, −1) while the body is level.
    Gravity,
    /// Wished velocity forward and left in m/s and turn rate to the left in rad/s.
    Commands,
    /// Angles in rad of some joints, each less its default angle. Those of wheels are 0.
    Positions(Vec<usize>),
    /// Speeds in rad/s of some joints.
    Velocities(Vec<usize>),
    /// The last values of the network, clipped and not scaled.
    Actions,
}

impl Source {
    /// Returns the number of values, of a robot with so many joints.
    pub fn len(&self, joints: usize) -> usize {
        match self {
            Self::LinearVelocity | Self::AngularVelocity | Self::Gravity | Self::Commands => 3,
            Self::Positions(joints) | Self::Velocities(joints) => joints.len(),
            Self::Actions => joints,
        }
    }
}
