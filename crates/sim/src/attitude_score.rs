//! Root-mean-square attitude error of a run, as `score.py` of the BROAD trials defines it.

use super::signals::{SignalTable, Values};

/// Errors over every 1 kHz sample with a valid estimate and a known reference; in a replay, those of the movement phase.
#[derive(Clone, Debug)]
pub struct AttitudeScore {
    errors: Option<[usize; 3]>,
    scored: Option<usize>,
    square_sums: [f64; 3],
    samples: u64,
}

impl AttitudeScore {
    pub fn new(table: &SignalTable) -> Self {
        let place = |part: &str| table.index(&format!("emu.att_error.{part}_deg"));
        Self {
            errors: match [place("total"), place("heading"), place("inclination")] {
                [Some(t), Some(h), Some(i)] => Some([t, h, i]),
                _ => None,
            },
            scored: table.index("truth.trial.mov"),
            square_sums: [0.0; 3],
            samples: 0,
        }
    }

    pub fn see(&mut self, values: &Values) {
        if self.scored.is_some_and(|i| values[i] != Some(1.0)) {
            return;
        }
        let Some(places) = self.errors else { return };
        let [Some(t), Some(h), Some(i)] = places.map(|p| values[p]) else {
            return;
        };
        for (sum, error) in self.square_sums.iter_mut().zip([t, h, i]) {
            *sum += error * error;
        }
        self.samples += 1;
    }

    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Total, heading and inclination in degrees; `None` where nothing could be scored.
    pub fn rmse_deg(&self) -> Option<[f64; 3]> {
        let n = self.samples as f64;
        (self.samples > 0).then(|| self.square_sums.map(|sum| (sum / n).sqrt()))
    }
}
