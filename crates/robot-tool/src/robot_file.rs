//! The file that every command asks for.

use clap::Args;
use robot_description::{Examined, Robot, RobotError, path_of};

/// The robot's file.
#[derive(Args)]
pub struct RobotFile {
    /// Name of a file in robots/, or a path.
    #[arg(value_name = "FILE|NAME", default_value = "fivebar")]
    name: String,
}

impl RobotFile {
    /// Reads it, with warnings.
    pub fn examine(&self) -> Result<Examined, RobotError> {
        Examined::read(&path_of(&self.name))
    }

    /// Reads it.
    pub fn read(&self) -> Result<Robot, RobotError> {
        Robot::read(&path_of(&self.name))
    }
}
