//! What can go wrong.

use robot_policy::{
    action::ActionError,
    observation::ObserveError,
    robot::{Implausible, OtherRobot},
};

/// Why an environment cannot be made or stepped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GymError {
    /// The policy is for another robot.
    #[error(transparent)]
    OtherRobot(#[from] OtherRobot),
    /// The policy runs at a rate that the environment does not have.
    #[error(
        "a policy that runs each {period_s} s does not fit a control loop of 1 ms: choose a dt of whole milliseconds, and \
         decimation so that their product is a multiple of 0.01 s"
    )]
    Period {
        /// Period of the policy in s.
        period_s: f64,
    },
    /// A robot did not arm.
    #[error("robot {seed} did not arm in mode PC: {why}")]
    NotArmed {
        /// Seed of the robot.
        seed: u64,
        /// What its firmware says.
        why: String,
    },
    /// The emulated board cannot be made or goes on no longer.
    #[error("emulated board: {0}")]
    Board(String),
    /// An image was given, and this was built without the emulated board.
    #[error(
        "elf: this was built without the emulated board; \
         MATURIN_PEP517_ARGS='--features python,board' pip install --no-build-isolation ./crates/gym"
    )]
    NoBoard,
    /// The observation cannot be made.
    #[error(transparent)]
    Observe(#[from] ObserveError),
    /// The action cannot be obeyed.
    #[error(transparent)]
    Action(#[from] ActionError),
    /// A state frame has a value that cannot be.
    #[error("state frame: {0}")]
    Implausible(#[from] Implausible),
    /// An array has the wrong length.
    #[error("{what}: {found} values, and {wanted} are needed")]
    Length {
        /// The array.
        what: &'static str,
        /// Values needed.
        wanted: usize,
        /// Values given.
        found: usize,
    },
    /// An option is out of its range.
    #[error("option {name}: {value} is not within {least} and {most}")]
    Option {
        /// The option.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Least value.
        least: f64,
        /// Greatest value.
        most: f64,
    },
}
