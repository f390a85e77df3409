//! Figures over a stretch of a run.

use crate::trial::Sample;

/// Root of the mean square of the deviation from the mean.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ripple {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Ripple {
    pub fn add(&mut self, value: f64) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    pub fn rms(&self) -> f64 {
        let mean = self.sum / self.count;
        (self.squares / self.count - mean * mean).max(0.0).sqrt()
    }

    pub fn mean(&self) -> f64 {
        self.sum / self.count
    }
}

/// Distance of the hip centre on the ground from where it was.
pub(crate) fn way_m(from: &Sample, to: &Sample) -> f64 {
    let [x, y, _] = from.place_m;
    let [now_x, now_y, _] = to.place_m;
    (now_x - x).hypot(now_y - y)
}
