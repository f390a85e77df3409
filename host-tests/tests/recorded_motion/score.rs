//! The metric of `data/broad/score.py`.

/// e = estimate · conj(reference), taken apart; radians.
pub struct AttitudeError {
    parts: [f64; 3],
}

impl AttitudeError {
    pub fn between(estimate: [f64; 4], reference: [f64; 4]) -> Self {
        let [aw, ax, ay, az] = estimate;
        let [bw, bx, by, bz] = reference;
        let w = aw * bw + ax * bx + ay * by + az * bz;
        let x = -aw * bx + ax * bw - ay * bz + az * by;
        let y = -aw * by + ax * bz + ay * bw - az * bx;
        let z = -aw * bz - ax * by + ay * bx + az * bw;
        let norm = (w * w + x * x + y * y + z * z).sqrt();
        let (w, z) = (w / norm, z / norm);
        let total = 2.0 * w.abs().min(1.0).acos();
        let heading = 2.0 * (z / w).abs().atan();
        let inclination = 2.0 * w.hypot(z).min(1.0).acos();
        Self {
            parts: [total, heading, inclination],
        }
    }
}

/// Root mean square of total, heading and inclination error.
#[derive(Default)]
pub struct Rmse {
    sums: [f64; 3],
    count: usize,
}

impl Rmse {
    pub fn add(&mut self, error: AttitudeError) {
        for (sum, part) in self.sums.iter_mut().zip(error.parts) {
            *sum += part * part;
        }
        self.count += 1;
    }

    pub fn degrees(&self) -> [f64; 3] {
        self.sums
            .map(|sum| (sum / self.count as f64).sqrt().to_degrees())
    }
}
