//! What the screens read in each period.

use std::{collections::BTreeMap, time::Duration};

use robot_arm::{
    bus::BusError,
    controller::{ControllerError, Positions, ServoController},
};

/// What the servos say now.
#[derive(Default)]
pub struct Seen {
    /// Positions of the joints that answer.
    pub steps: BTreeMap<String, i32>,
    /// Why there is no position of the others.
    pub errors: Vec<String>,
    /// What else has happened, said once.
    pub warnings: Vec<String>,
}

/// Reads the positions. A port that was lost is opened again once it is back.
pub fn look(arm: &mut ServoController) -> Seen {
    let texts =
        |errors: &[robot_arm::bus::ServoError]| errors.iter().map(ToString::to_string).collect();
    let mut seen = match arm.read_positions() {
        Ok(Positions { steps, errors }) => Seen {
            steps,
            errors: texts(&errors),
            warnings: Vec::new(),
        },
        Err(error) => {
            if let ControllerError::Bus(BusError::Wire(_)) = error {
                // The next look tries again.
                let _ = arm.reconnect(Duration::ZERO);
            }
            Seen {
                errors: vec![error.to_string()],
                ..Seen::default()
            }
        }
    };
    seen.warnings = arm
        .take_warnings()
        .iter()
        .map(ToString::to_string)
        .collect();
    seen
}
