//! Is the robot at rest? (VQF section 3.5, default thresholds)

use super::{SAMPLE_S, low_pass::LowPass};
use crate::math::{Vector3, vector};

const FILTER_S: f32 = 0.5;
const MIN_REST_S: f32 = 1.5;
const MAX_GYRO_DEVIATION_RPS: f32 = 2.0_f32.to_radians();
const MAX_ACCEL_DEVIATION_MPS2: f32 = 0.5;

#[derive(Clone, Debug)]
pub(super) struct RestDetector {
    gyro: LowPass<3>,
    accel: LowPass<3>,
    rest_s: f32,
}

impl RestDetector {
    pub fn new() -> Self {
        Self {
            gyro: LowPass::new(FILTER_S, SAMPLE_S),
            accel: LowPass::new(FILTER_S, SAMPLE_S),
            rest_s: 0.0,
        }
    }

    pub fn reset(&mut self) {
        self.gyro.reset();
        self.accel.reset();
        self.rest_s = 0.0;
    }

    /// `max_rate_rps`: a steady rate above this is a rotation, not an offset. The smoothed rate while at rest.
    pub fn feed(
        &mut self,
        gyro_rps: Vector3,
        accel_mps2: Vector3,
        max_rate_rps: f32,
    ) -> Option<Vector3> {
        let smooth_gyro = self.gyro.feed(gyro_rps);
        let smooth_accel = self.accel.feed(accel_mps2);
        let moved = squared_distance(gyro_rps, smooth_gyro)
            >= MAX_GYRO_DEVIATION_RPS * MAX_GYRO_DEVIATION_RPS
            || squared_distance(accel_mps2, smooth_accel)
                >= MAX_ACCEL_DEVIATION_MPS2 * MAX_ACCEL_DEVIATION_MPS2
            || smooth_gyro.iter().any(|rate| rate.abs() > max_rate_rps);
        self.rest_s = if moved { 0.0 } else { self.rest_s + SAMPLE_S };
        (self.rest_s >= MIN_REST_S).then_some(smooth_gyro)
    }

    /// Rate of turn, smoothed.
    pub fn smooth_rate_rps(&self) -> f32 {
        vector::norm(self.gyro.output())
    }
}

fn squared_distance(a: Vector3, b: Vector3) -> f32 {
    let difference = vector::sub(a, b);
    vector::dot(difference, difference)
}
