//! What becomes of the arm when its controller ends.

use std::str::FromStr;

use super::ServoController;

/// What an arm does when the program that moves it ends, however it ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ending {
    /// It stops and stays where it is, with torque. An arm without torque falls, with all that it carries, so this is the default.
    /// A servo that holds a load gets warm: release an arm that nobody watches.
    #[default]
    Hold,
    /// Its torque goes off and it falls: for an arm that lies or hangs.
    Release,
}

impl FromStr for Ending {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "hold" => Ok(Self::Hold),
            "release" => Ok(Self::Release),
            _ => Err(format!("{text}: an arm can hold or release at the end")),
        }
    }
}

impl Drop for ServoController {
    fn drop(&mut self) {
        if !self.has_torque() {
            return;
        }
        // Nobody is left to tell of an error, and without a port nothing can be done.
        let _ = match self.ending {
            Ending::Hold => self.hold(),
            Ending::Release => self.release(),
        };
    }
}
