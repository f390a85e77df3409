//! An attitude sampled at equal steps of time, and interpolated between them.

use robot_plant::attitude::{self, Quaternion};

/// Times that differ by less than this are the same.
const SAME_S: f64 = 1e-4;
/// There is no interpolation over a longer gap.
const MAX_GAP_S: f64 = 0.05;

pub struct Track {
    pub start_s: f64,
    pub period_s: f64,
    /// NaN where it is not known.
    pub attitudes: Vec<Quaternion>,
}

impl Track {
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 * self.period_s
    }

    /// Returns the normalised linear interpolation between the two neighbours. It is `None` outside the track and where
    /// a neighbour is not known.
    pub fn at(&self, t_s: f64) -> Option<Quaternion> {
        let steps = (t_s - SAME_S - self.start_s) / self.period_s;
        let last = self.attitudes.len().checked_sub(1)?;
        let above = (steps.ceil().max(1.0) as usize).min(last);
        let below = above.saturating_sub(1);
        for index in [below, above] {
            if (t_s - self.time_s(index)).abs() <= SAME_S {
                return attitude::normalised(self.attitudes[index]);
            }
        }
        let share = (t_s - self.time_s(below)) / self.period_s;
        let bridged = (0.0..=1.0).contains(&share) && self.period_s <= MAX_GAP_S;
        let line = attitude::between(self.attitudes[below], self.attitudes[above], share);
        line.filter(|_| bridged)
    }
}
