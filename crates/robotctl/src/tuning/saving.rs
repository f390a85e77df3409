//! Waits until a change is in the robot's flash.

use std::{thread, time::Duration};

use robot_app::domain::ParamState;

use super::{StoreReport, TuningClient, TuningError};

/// How long to wait for a save.
#[derive(Clone, Copy, Debug)]
pub struct SaveTimeouts {
    pub pause: Duration,
    pub looks: u32,
}

impl Default for SaveTimeouts {
    /// Waits for five seconds: half a second of quiet, an erase, and one repetition a second later.
    fn default() -> Self {
        Self {
            pause: Duration::from_millis(100),
            looks: 50,
        }
    }
}

#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    #[error("whether the new values are saved is not known")]
    Unknown(#[from] TuningError),
    #[error(
        "this firmware saves no settings: the new values are in use until the robot is switched off or reset"
    )]
    NeverSaves,
    #[error("the new values are in use but not saved yet: {}", advice(.0))]
    NotSaved(StoreReport),
}

/// Asks until the robot has saved all changes.
pub fn wait_until_saved(
    client: &mut TuningClient,
    timeouts: SaveTimeouts,
) -> Result<StoreReport, SaveError> {
    let mut looks = 1;
    loop {
        let report = client.store()?.ok_or(SaveError::NeverSaves)?;
        if report.is_saved() {
            return Ok(report);
        }
        if looks >= timeouts.looks {
            return Err(SaveError::NotSaved(report));
        }
        looks += 1;
        thread::sleep(timeouts.pause);
    }
}

/// Says why the save takes long and what to do.
fn advice(report: &StoreReport) -> String {
    const WATCH: &str = "leave the robot switched on until `robotctl tune status` says saved";
    match report.state {
        Ok(ParamState::BackingOff) => format!(
            "the robot cannot write them ({}) and goes on trying; {WATCH}, and keep a copy with `robotctl tune save`",
            report.error_in_words()
        ),
        Ok(ParamState::WaitingForRest) => format!(
            "the robot saves once it has been disarmed for half a second and its enable switch is off, and erases when wheels and joints rest too; {WATCH}"
        ),
        _ => format!("someone may be changing settings still; {WATCH}"),
    }
}
