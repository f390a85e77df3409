//! Plays impacts, and measures the attitude.

use robot_replay::{At, Trial};

use crate::{
    board::{self, Wheels},
    motion::{self, Base, Impact},
    record::Recording,
};

/// The estimate may be late by some milliseconds of an impact.
const IMPACT_DELAY_S: f64 = 0.05;
/// Long enough to be righted and to drive for a while.
const AFTERWARDS_S: f64 = 8.0;
/// Time within which rest shows the tilt.
const REST_S: f64 = 1.5;
const DRIVING_S: f64 = 4.0;

#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Largest tilt error from the time on at which the tilt must be known again.
    pub late_deg: f64,
    /// Largest tilt error while the estimate was valid, without the impacts themselves.
    pub valid_error_deg: f64,
    /// Time from upright until the estimate was valid for good.
    pub valid_after_s: f64,
    pub rejected: u32,
    /// The estimate was valid and showed a fallen robot for longer than a knock, though it had not fallen.
    pub falls: bool,
}

impl Outcome {
    pub fn of(name: &str, base: Base, impacts: &[Impact]) -> Self {
        Self::try_of(name, base, impacts).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn worse_of(&self, other: &Self) -> Self {
        Self {
            late_deg: self.late_deg.max(other.late_deg),
            valid_error_deg: self.valid_error_deg.max(other.valid_error_deg),
            valid_after_s: self.valid_after_s.max(other.valid_after_s),
            rejected: self.rejected.max(other.rejected),
            falls: self.falls || other.falls,
        }
    }

    fn try_of(name: &str, base: Base, impacts: &[Impact]) -> anyhow::Result<Self> {
        let end_s = impacts.last().map_or(0.0, Impact::end_s);
        let (rows, upright_s) = motion::rows(
            base,
            impacts,
            end_s + AFTERWARDS_S,
            1 + impacts.len() as u64,
        );
        let recording = Recording::write(name, &rows)?;
        let trial = Trial::read(&recording.header)?;
        let wheels = match base {
            Base::Driving => Wheels::Silent,
            Base::Standing | Base::Turning { .. } => Wheels::Standing,
        };
        let (run, rejected) = board::play(&recording.header, 0, wheels)?;
        let known_s = upright_s
            + if base == Base::Driving {
                DRIVING_S
            } else {
                REST_S
            };
        let first_s = impacts.first().map_or(0.0, |impact| impact.at_s);
        let mut outcome = Self {
            late_deg: 0.0,
            valid_error_deg: 0.0,
            valid_after_s: -upright_s,
            rejected,
            falls: false,
        };
        let mut fallen_ms = 0;
        for (tick, instant) in run.ticks.iter().zip(run.compare(&trial, At::EveryTick)) {
            let t_s = tick.t_us as f64 * 1e-6;
            let Some(error_deg) = instant.error.map(|error| error.inclination_deg()) else {
                continue;
            };
            if t_s < first_s {
                continue;
            }
            if t_s >= known_s {
                outcome.late_deg = outcome.late_deg.max(error_deg);
            }
            let struck =
                |impact: &Impact| (impact.at_s..impact.end_s() + IMPACT_DELAY_S).contains(&t_s);
            if tick.valid && !impacts.iter().any(struck) {
                outcome.valid_error_deg = outcome.valid_error_deg.max(error_deg);
            }
            if !tick.valid {
                outcome.valid_after_s = t_s - upright_s;
            }
            let [_, x, y, _] = tick.q_wxyz;
            let shows_fall = tick.valid && 2.0 * x.hypot(y).asin() > 0.9;
            let row = &rows[((tick.t_us / 1_000) as usize).min(rows.len() - 1)];
            let [_, x, y, _] = row.q_wxyz;
            let real_fall = 2.0 * x.hypot(y).asin() > 0.85;
            fallen_ms = if shows_fall && !real_fall {
                fallen_ms + 1
            } else {
                0
            };
            outcome.falls |= fallen_ms > 50;
        }
        Ok(outcome)
    }
}
