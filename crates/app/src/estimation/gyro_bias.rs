//! The gyro offset as a Kalman filter with three states (VQF section 3.4, default noise figures).

use super::{SAMPLE_S, low_pass::LowPass};
use crate::math::{Vector3, vector};

/// Beyond this it is a motion, not an offset.
pub(super) const MAX_BIAS_RPS: f32 = 2.0_f32.to_radians();
const INITIAL_STD_RPS: f32 = 0.5_f32.to_radians();
const REST_STD_RPS: f32 = 0.03_f32.to_radians();
const MOTION_STD_RPS: f32 = 0.1_f32.to_radians();
/// Time in which the offset may wander by 0.1 °/s.
const FORGETTING_S: f32 = 100.0;
const DRIFT_STD_RPS: f32 = 0.1_f32.to_radians();
/// How weakly the offset about the vertical, which gravity cannot show, is pulled to zero.
const VERTICAL_WEIGHT: f32 = 0.0001;
/// Time constant of the inclination correction whose residual is observed.
const INCLINATION_S: f32 = 3.0;

const DRIFT: f32 = DRIFT_STD_RPS * DRIFT_STD_RPS * SAMPLE_S / FORGETTING_S;
const INITIAL_VARIANCE: f32 = INITIAL_STD_RPS * INITIAL_STD_RPS;

/// Measurement variance that makes the filter settle at `std` while the offset drifts.
const fn measurement_variance(std: f32) -> f32 {
    let variance = std * std;
    variance * variance / DRIFT + variance
}

const REST_VARIANCE: f32 = measurement_variance(REST_STD_RPS);
const MOTION_VARIANCE: f32 = measurement_variance(MOTION_STD_RPS);

#[derive(Clone, Debug)]
pub(super) struct GyroBias {
    bias_rps: Vector3,
    covariance: [Vector3; 3],
    /// Rotation matrix, low-passed as gravity is.
    rotation: LowPass<9>,
    /// Level components of the offset, low-passed as gravity is.
    level_bias: LowPass<2>,
}

impl GyroBias {
    pub fn new() -> Self {
        let p = INITIAL_VARIANCE;
        Self {
            bias_rps: [0.0; 3],
            covariance: [[p, 0.0, 0.0], [0.0, p, 0.0], [0.0, 0.0, p]],
            rotation: LowPass::new(INCLINATION_S, SAMPLE_S),
            level_bias: LowPass::new(INCLINATION_S, SAMPLE_S),
        }
    }

    pub const fn bias_rps(&self) -> Vector3 {
        self.bias_rps
    }

    /// The offset was taken out of the samples elsewhere.
    pub fn restart_at_zero(&mut self) {
        self.bias_rps = [0.0; 3];
        self.rotation.reset();
        self.level_bias.reset();
    }

    pub fn forget_motion(&mut self) {
        self.rotation.reset();
        self.level_bias.reset();
    }

    /// `body_to_level`: rows of the present attitude without heading. `level_accel`: smoothed gravity in that frame,
    /// unit length, before it was corrected to point up. `rest_rate_rps`: smoothed rate if at rest.
    pub fn update(
        &mut self,
        body_to_level: [Vector3; 3],
        level_accel: Vector3,
        rest_rate_rps: Option<Vector3>,
    ) {
        let [row_x, row_y, row_z] = body_to_level;
        let bias = self.bias_rps;
        let smooth_bias = self
            .level_bias
            .feed([vector::dot(row_x, bias), vector::dot(row_y, bias)]);
        let smooth_rows = self.rotation.feed([
            row_x[0], row_x[1], row_x[2], row_y[0], row_y[1], row_y[2], row_z[0], row_z[1],
            row_z[2],
        ]);
        self.drift();
        match rest_rate_rps {
            Some([x, y, z]) => {
                self.observe([1.0, 0.0, 0.0], x, REST_VARIANCE);
                self.observe([0.0, 1.0, 0.0], y, REST_VARIANCE);
                self.observe([0.0, 0.0, 1.0], z, REST_VARIANCE);
            }
            None => self.observe_gravity(smooth_rows, smooth_bias, level_accel),
        }
        self.bias_rps = self
            .bias_rps
            .map(|rate| rate.clamp(-MAX_BIAS_RPS, MAX_BIAS_RPS));
    }

    /// What keeps tilting the estimate is what is left of the offset.
    fn observe_gravity(&mut self, rows: [f32; 9], smooth_bias: [f32; 2], level_accel: Vector3) {
        let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = rows;
        let [ax, ay, _] = level_accel;
        let [bias_x, bias_y] = smooth_bias;
        self.observe([xx, xy, xz], bias_x - ay / SAMPLE_S, MOTION_VARIANCE);
        self.observe([yx, yy, yz], bias_y + ax / SAMPLE_S, MOTION_VARIANCE);
        self.observe([zx, zy, zz], 0.0, MOTION_VARIANCE / VERTICAL_WEIGHT);
    }

    fn drift(&mut self) {
        let [[xx, ..], [_, yy, _], [.., zz]] = &mut self.covariance;
        for variance in [xx, yy, zz] {
            if *variance < INITIAL_VARIANCE {
                *variance += DRIFT;
            }
        }
    }

    /// One scalar measurement: `direction` · bias = `rate_rps`.
    fn observe(&mut self, direction: Vector3, rate_rps: f32, variance: f32) {
        let residual =
            (rate_rps - vector::dot(direction, self.bias_rps)).clamp(-MAX_BIAS_RPS, MAX_BIAS_RPS);
        let spread = self.covariance.map(|row| vector::dot(row, direction));
        let inverse = 1.0 / (variance + vector::dot(direction, spread));
        self.bias_rps = vector::add(self.bias_rps, vector::scale(spread, residual * inverse));
        for (row, factor) in self.covariance.iter_mut().zip(spread) {
            *row = vector::sub(*row, vector::scale(spread, factor * inverse));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEVEL: [Vector3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn at_rest_the_rate_is_the_offset() {
        let mut filter = GyroBias::new();
        let offset = [0.01, -0.02, 0.005];
        for _ in 0..2_000 {
            filter.update(LEVEL, [0.0, 0.0, 1.0], Some(offset));
        }
        for (got, expected) in filter.bias_rps().iter().zip(offset) {
            assert!((got - expected).abs() < 2e-4, "{:?}", filter.bias_rps());
        }
    }

    #[test]
    fn the_offset_stays_inside_its_limit() {
        let mut filter = GyroBias::new();
        for _ in 0..10_000 {
            filter.update(LEVEL, [0.5, 0.5, 0.7], None);
        }
        assert!(
            filter
                .bias_rps()
                .iter()
                .all(|rate| rate.abs() <= MAX_BIAS_RPS)
        );
    }
}
