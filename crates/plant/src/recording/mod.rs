//! A recorded trial played through the IMU and magnetometer models.
//!
//! The robot stands still while the record plays: the record moves its sensors only.

mod trial;

use std::path::Path;

use crate::{
    attitude::{self, Quaternion},
    bmi088::Motion,
    time::{MS, Ps, US, to_seconds},
    world::{PHYSICS_STEP, WorldError},
};
pub use trial::{Row, Trial};

/// Room for boot and sensor start-up before the record begins. Until then its first moments, which are all at rest,
/// play backwards: real noise, and no jump where the record starts.
const LEAD_IN: Ps = 1_000 * MS;
/// How long before the board's own sampling a row is put into the registers. Both sensor dies are read within this.
const ROW_BEFORE_READ: Ps = 300 * US;
/// The slowest board the records suit reads at their own rate of 200 Hz.
const LONGEST_READ_PERIOD: Ps = 5 * MS;

/// How long a run lasts that plays all of the trial `header` describes: lead-in, the wait for the board's next read,
/// and every row.
pub fn run_length(header: &Path) -> Result<Ps, WorldError> {
    Ok(LEAD_IN + LONGEST_READ_PERIOD + trial::duration(header)?)
}

pub(crate) struct Playback {
    trial: Trial,
    /// Instant at which row 0 enters the sensors' registers.
    rows_from: Ps,
    /// Instant that counts as the end of row 0's interval, where its reference belongs: the board's read of it.
    reference_from: Ps,
    locked: bool,
}

impl Playback {
    pub(crate) fn open(header: &Path) -> Result<Self, WorldError> {
        Ok(Self {
            trial: Trial::load(header)?,
            rows_from: LEAD_IN,
            reference_from: LEAD_IN,
            locked: false,
        })
    }

    /// Puts row 0 just before the board's first read after the lead-in, and returns that instant, once.
    ///
    /// A row is the average over the 5 ms that end with it, and its reference is the attitude at their end. So a board
    /// that samples at the record's rate sees each row once, and the reference runs from the instant it read row 0.
    /// Without this, the unknown phase between record and board would count as up to 5 ms of rotation.
    pub(crate) fn lock_to_read(&mut self, read_at: Ps) -> Option<Ps> {
        if self.locked || read_at < LEAD_IN {
            return None;
        }
        self.locked = true;
        self.reference_from = read_at;
        self.rows_from = (read_at - ROW_BEFORE_READ) / PHYSICS_STEP * PHYSICS_STEP;
        Some(self.rows_from)
    }

    /// Time in the record in s, negative in the lead-in.
    pub(crate) fn time_s(&self, now: Ps) -> f64 {
        to_seconds(now) - to_seconds(self.reference_from)
    }

    /// Held from one row to the next; before the record it runs backwards, after it the last row stays.
    fn row(&self, now: Ps) -> Row {
        let since = now.abs_diff(self.rows_from);
        let index = self.trial.index_at(since);
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

    /// True in the movement phase, which is the part that is scored.
    pub(crate) fn moving(&self, now: Ps) -> bool {
        now >= self.rows_from && self.row(now).moving
    }

    /// Reference attitude between its two neighbouring rows; `None` in a gap of the cameras and outside the record.
    pub(crate) fn reference(&self, now: Ps) -> Option<Quaternion> {
        let since = now.checked_sub(self.reference_from)?;
        let (index, share) = self.trial.position_at(since)?;
        let here = self.trial.row(index).reference_wxyz;
        if share < 1e-6 {
            return attitude::between(here, here, 0.0);
        }
        attitude::between(here, self.trial.row(index + 1).reference_wxyz, share)
    }
}
