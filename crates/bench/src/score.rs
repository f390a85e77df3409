//! The metric of the BROAD trials (`score.py` beside the data).

use serde::Serialize;

/// Sums of squares of total, heading and inclination error, radians.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    sums: [f64; 3],
    samples: u64,
}

/// Root mean square, degrees.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rmse {
    pub total_deg: f64,
    pub heading_deg: f64,
    pub inclination_deg: f64,
}

impl Score {
    /// e = estimate · conj(reference), taken apart.
    pub fn add(&mut self, estimate: [f32; 4], reference: [f64; 4]) {
        let [aw, ax, ay, az] = estimate.map(f64::from);
        let [bw, bx, by, bz] = reference;
        let w = aw * bw + ax * bx + ay * by + az * bz;
        let x = -aw * bx + ax * bw - ay * bz + az * by;
        let y = -aw * by + ax * bz + ay * bw - az * bx;
        let z = -aw * bz - ax * by + ay * bx + az * bw;
        let norm = (w * w + x * x + y * y + z * z).sqrt();
        let (w, z) = (w / norm, z / norm);
        let parts = [
            2.0 * w.abs().min(1.0).acos(),
            2.0 * (z / w).abs().atan(),
            2.0 * w.hypot(z).min(1.0).acos(),
        ];
        for (sum, part) in self.sums.iter_mut().zip(parts) {
            *sum += part * part;
        }
        self.samples += 1;
    }

    /// `None` where there is no reference.
    pub fn rmse(&self) -> Option<Rmse> {
        let root = |sum: f64| (sum / self.samples as f64).sqrt().to_degrees();
        let [total_deg, heading_deg, inclination_deg] = self.sums.map(root);
        (self.samples > 0).then_some(Rmse {
            total_deg,
            heading_deg,
            inclination_deg,
        })
    }
}

impl Rmse {
    /// Mean over trials; `None` if there is none.
    pub fn mean(trials: &[Self]) -> Option<Self> {
        let mean = |of: fn(&Self) -> f64| trials.iter().map(of).sum::<f64>() / trials.len() as f64;
        (!trials.is_empty()).then(|| Self {
            total_deg: mean(|rmse| rmse.total_deg),
            heading_deg: mean(|rmse| rmse.heading_deg),
            inclination_deg: mean(|rmse| rmse.inclination_deg),
        })
    }
}
