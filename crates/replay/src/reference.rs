//! The recorded attitude that estimates are compared with.

use robot_plant::{recording, time::to_seconds};

use crate::track::Track;

pub struct Reference {
    pub track: Track,
    /// True for each row in the scored phase.
    scored: Vec<bool>,
}

impl Reference {
    /// `None` if the recording has no attitude at all.
    pub fn new(recording: &recording::Trial) -> Option<Self> {
        let rows = recording.rows();
        let known = rows.iter().any(|row| !row.reference_wxyz[0].is_nan());
        known.then(|| Self {
            track: Track {
                start_s: 0.0,
                period_s: to_seconds(recording.row_period()),
                attitudes: rows.iter().map(|row| row.reference_wxyz).collect(),
            },
            scored: rows.iter().map(|row| row.moving).collect(),
        })
    }

    /// True if the row nearest in time is scored.
    pub fn scored(&self, t_s: f64) -> bool {
        let row = (t_s / self.track.period_s).round_ties_even().max(0.0) as usize;
        let last = self.scored.len().saturating_sub(1);
        self.scored.get(row.min(last)).copied().unwrap_or(false)
    }
}
