//! The error between two attitudes (D. Laidig et al., "BROAD", Data 6 (7), 2021, section 4).

use super::quaternion::{Quaternion, conjugate, multiply};

/// e = estimate · conj(reference): the rotation in the earth frame that takes the reference to the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeError {
    w: f64,
    x: f64,
    y: f64,
    z: f64,
}

impl AttitudeError {
    /// Both arguments are unit quaternions.
    pub fn between(estimate: Quaternion, reference: Quaternion) -> Self {
        let [w, x, y, z] = multiply(estimate, conjugate(reference));
        Self { w, x, y, z }
    }

    /// 2 acos |w|, the angle of the whole rotation, 0 … 180°. Here and below the arc tangent equals the arc cosine of the
    /// definition and keeps its precision near zero.
    pub fn total_deg(self) -> f64 {
        let Self { w, x, y, z } = self;
        2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs()).to_degrees()
    }

    /// 2 atan (z / w), the part about the vertical, ±180°; positive where the estimate is too far to the left.
    pub fn heading_deg(self) -> f64 {
        2.0 * (self.z * self.w.signum()).atan2(self.w.abs()).to_degrees()
    }

    /// 2 acos √(w² + z²), the angle between the two verticals, 0 … 180°.
    pub fn inclination_deg(self) -> f64 {
        let Self { w, x, y, z } = self;
        2.0 * x.hypot(y).atan2(w.hypot(z)).to_degrees()
    }

    /// The error that is left when the estimate is turned by this angle to the right.
    pub fn without_heading(self, heading_rad: f64) -> Self {
        let (sin, cos) = (heading_rad / 2.0).sin_cos();
        Self {
            w: cos * self.w + sin * self.z,
            x: cos * self.x + sin * self.y,
            y: cos * self.y - sin * self.x,
            z: cos * self.z - sin * self.w,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-5
    }

    #[test]
    fn a_turn_is_a_heading_error_and_a_tilt_an_inclination_error() {
        let (sin, cos) = 10_f64.to_radians().sin_cos();
        let level = [1.0, 0.0, 0.0, 0.0];
        let turned = AttitudeError::between([cos, 0.0, 0.0, -sin], level);
        assert!(close(turned.heading_deg(), -20.0) && close(turned.inclination_deg(), 0.0));
        let tilted = AttitudeError::between([cos, 0.0, sin, 0.0], level);
        assert!(close(tilted.heading_deg(), 0.0) && close(tilted.inclination_deg(), 20.0));
        assert!(close(tilted.total_deg(), 20.0));
    }

    #[test]
    fn a_known_heading_is_taken_out_of_a_tilted_estimate() {
        let (sin, cos) = 15_f64.to_radians().sin_cos();
        let (turn_sin, turn_cos) = 25_f64.to_radians().sin_cos();
        // Tilted by 30° about x, then turned by 50° about the vertical.
        let q = [
            turn_cos * cos,
            turn_cos * sin,
            turn_sin * sin,
            turn_sin * cos,
        ];
        let left =
            AttitudeError::between(q, [1.0, 0.0, 0.0, 0.0]).without_heading(50_f64.to_radians());
        assert!(close(left.heading_deg(), 0.0) && close(left.total_deg(), 30.0));
    }
}
