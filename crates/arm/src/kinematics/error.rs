//! What is wrong with an arm's description, or with what it is asked.

/// A description that is no arm, or a question that does not fit the arm.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KinematicsError {
    /// It has no joint, or too many.
    #[error(
        "{found} joints: an arm has 1 to {allowed}. Name a base and a tip that have only the arm between them"
    )]
    JointCount {
        /// Joints of the chain.
        found: usize,
        /// Joints that an arm may have.
        allowed: usize,
    },
    /// There are more or fewer names than joints.
    #[error(
        "{joints} joints are named, and the transforms hold {transforms}: name each joint once, in the chain's order"
    )]
    Names {
        /// Joints that are named.
        joints: usize,
        /// Joints among the transforms.
        transforms: usize,
    },
    /// Two joints have one name.
    #[error("joint {joint} is there twice: give each a name of its own")]
    Twice {
        /// The name.
        joint: String,
    },
    /// A limit is NaN, or the upper one is below the lower one.
    #[error(
        "joint {joint}: limits {lower} to {upper} hold no value: the lower one comes first, in rad or m"
    )]
    Limits {
        /// The joint.
        joint: String,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// A gear that is none.
    #[error(
        "gear_sign {sign}, gear_ratio {ratio}: the sign is 1 or -1, and the ratio is greater than 0"
    )]
    Gear {
        /// The sign.
        sign: f64,
        /// The ratio.
        ratio: f64,
    },
    /// A transform, a base, a tool or a target holds NaN or infinity.
    #[error("{what} holds NaN or infinity")]
    NotFinite {
        /// What does.
        what: &'static str,
    },
    /// The wrong number of joint values.
    #[error("{what} has {found} values, and {wanted} are needed")]
    Length {
        /// What has the wrong number.
        what: &'static str,
        /// Values that it has.
        found: usize,
        /// Joints of the arm.
        wanted: usize,
    },
    /// The arm has no joint of this name.
    #[error("there is no joint {joint}: the arm has {known}")]
    UnknownJoint {
        /// The name.
        joint: String,
        /// Names of the arm's joints.
        known: String,
    },
    /// A joint has no home, or its position was not read.
    #[error("{what} has no {joint}: it must name each joint that is asked for")]
    Missing {
        /// What lacks it.
        what: &'static str,
        /// The joint.
        joint: String,
    },
    /// A URDF that describes no serial arm.
    #[error("line {line}: {message}")]
    Urdf {
        /// Line of the URDF, from 1.
        line: u32,
        /// What is wrong, and the cure.
        message: String,
    },
}
