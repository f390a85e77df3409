//! The error of an estimate against the truth.

use robot_test_support::Rotation;

/// The rotation estimate · truth⁻¹, split into one about the vertical and one about a level axis.
#[derive(Clone, Copy, Debug)]
pub struct AttitudeError {
    pub total_deg: f64,
    /// Positive to the left, ±180.
    pub heading_deg: f64,
    /// 0 … 180.
    pub inclination_deg: f64,
}

impl AttitudeError {
    pub fn between(estimate: Rotation, truth: Rotation) -> Self {
        let error = estimate.then_in_body(truth.inverse());
        let [w, x, y, z] = error.to_wxyz();
        Self {
            total_deg: error.angle_deg(),
            heading_deg: wrapped_deg(2.0 * z.atan2(w).to_degrees()),
            inclination_deg: 2.0 * x.hypot(y).atan2(z.hypot(w)).to_degrees(),
        }
    }
}

/// Wraps an angle into ±180.
pub fn wrapped_deg(angle_deg: f64) -> f64 {
    angle_deg - 360.0 * (angle_deg / 360.0).round()
}

/// The largest absolute errors over some time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    pub total_deg: f64,
    pub heading_deg: f64,
    pub inclination_deg: f64,
    /// Change of the heading error since the beginning. Without a magnetometer only that is meaningful.
    pub heading_drift_deg: f64,
    /// Rotation between two ticks beyond the true one.
    pub jump_deg: f64,
}

impl Worst {
    pub fn add(&mut self, error: AttitudeError, first: AttitudeError, jump_deg: f64) {
        let drift_deg = wrapped_deg(error.heading_deg - first.heading_deg).abs();
        self.total_deg = self.total_deg.max(error.total_deg);
        self.heading_deg = self.heading_deg.max(error.heading_deg.abs());
        self.inclination_deg = self.inclination_deg.max(error.inclination_deg);
        self.heading_drift_deg = self.heading_drift_deg.max(drift_deg);
        self.jump_deg = self.jump_deg.max(jump_deg);
    }
}
