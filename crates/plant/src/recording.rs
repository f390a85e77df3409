//! A recorded trial played through the IMU and magnetometer models.
//!
//! The robot stands still while the record plays: only its sensors are moved.

mod error;
mod trial;

use std::path::Path;

use crate::{
    attitude::{self, Quaternion},
    motion::Motion,
    time::{MS, Ps, to_seconds},
};
pub use error::{TrialDefect, TrialError};
pub use trial::{Row, Trial};

/// Time for boot and sensor start-up before the record begins. Until then the first moments of the record, which are all at
/// rest, play backwards: this gives real noise and no jump where the record starts.
pub const LEAD_IN: Ps = 1_000 * MS;

/// Length of a run that plays the whole trial that `header` describes: the lead-in and every row.
///
/// # Errors
/// The header cannot be read.
pub fn run_length(header: &Path) -> Result<Ps, TrialError> {
    Ok(LEAD_IN + trial::duration(header)?)
}

/// A trial as the motion of the board's sensors. The delays of the recorder's sensors and of the board's add up.
#[derive(Clone)]
pub(crate) struct Playback {
    trial: Trial,
}

impl Playback {
    pub(crate) fn open(header: &Path) -> Result<Self, TrialError> {
        let mut trial = Trial::load(header)?;
        trial.bridge_failures();
        Ok(Self { trial })
    }

    /// Time in the record in s. It is negative in the lead-in, and row 0 ends at 0.
    pub(crate) fn time_s(&self, now: Ps) -> f64 {
        to_seconds(now) - to_seconds(LEAD_IN)
    }

    /// The row whose interval contains `now`. Before the record it runs backwards, after it the last row stays.
    fn row(&self, now: Ps) -> Row {
        let index = match now.checked_sub(LEAD_IN) {
            Some(since) => self.trial.index_ending_after(since),
            None => self.trial.index_at(LEAD_IN - now),
        };
        self.trial.row(index)
    }

    pub(crate) fn motion(&self, now: Ps) -> Motion {
        let row = self.row(now);
        Motion {
            accel_mps2: row.accel_mps2,
            gyro_rps: row.gyro_rps,
        }
    }

    pub(crate) fn field_ut(&self, now: Ps) -> [f64; 3] {
        self.row(now).field_ut
    }

    /// True in the movement phase, which is the part that counts for the score.
    pub(crate) fn moving(&self, now: Ps) -> bool {
        let since = now.checked_sub(LEAD_IN);
        since.is_some_and(|since| self.trial.row(self.trial.index_at(since)).moving)
    }

    /// Reference attitude between its two neighbouring rows; `None` in a gap of the cameras and outside the record.
    pub(crate) fn reference(&self, now: Ps) -> Option<Quaternion> {
        let since = now.checked_sub(LEAD_IN)?;
        let (index, share) = self.trial.position_at(since)?;
        let here = self.trial.row(index).reference_wxyz;
        if share < 1e-6 {
            return attitude::between(here, here, 0.0);
        }
        attitude::between(here, self.trial.row(index + 1).reference_wxyz, share)
    }
}
