//! Attitude from gyro, accelerometer and magnetometer.

use super::{
    SAMPLE_S,
    gyro_bias::{GyroBias, MAX_BIAS_RPS},
    heading::Heading,
    low_pass::LowPass,
    rest::RestDetector,
};
use crate::math::{Quaternion, Vector3, scalar, vector};

/// Time constant with which gravity corrects the inclination.
const INCLINATION_S: f32 = 3.0;
/// A rotation in one step beyond this is not followed: the quaternion step is made for small angles.
const MAX_STEP_RAD: f32 = 0.9;

/// Sensor frame → frame turned by the gyro alone → level frame → ENU.
#[derive(Clone, Debug)]
pub(super) struct AttitudeFilter {
    gyro_turned: Quaternion,
    inclination: Quaternion,
    heading: Heading,
    gravity: LowPass<3>,
    bias: GyroBias,
    rest: RestDetector,
    /// Without offset, of the last sample.
    rate_rps: Vector3,
}

impl AttitudeFilter {
    pub fn new() -> Self {
        Self {
            gyro_turned: Quaternion::IDENTITY,
            inclination: Quaternion::IDENTITY,
            heading: Heading::new(),
            gravity: LowPass::new(INCLINATION_S, SAMPLE_S),
            bias: GyroBias::new(),
            rest: RestDetector::new(),
            rate_rps: [0.0; 3],
        }
    }

    /// One IMU sample, whose rate held over the `dt_s` before it. Without an acceleration the gyro alone carries on.
    pub fn feed_imu(&mut self, gyro_rps: Vector3, accel_mps2: Option<Vector3>, dt_s: f32) {
        self.rate_rps = vector::sub(gyro_rps, self.bias.bias_rps());
        self.gyro_turned = self
            .gyro_turned
            .after(step_rotation(self.rate_rps, dt_s))
            .normalised();
        let Some(accel_mps2) = accel_mps2 else {
            return;
        };
        let rest_rate = self.rest.feed(gyro_rps, accel_mps2, MAX_BIAS_RPS);
        let Some(level_accel) = self.correct_inclination(accel_mps2) else {
            return;
        };
        let body_to_level = self.level().rotation_matrix();
        self.bias.update(body_to_level, level_accel, rest_rate);
    }

    /// Turns the level frame so that smoothed gravity points up. Gravity as it was before, unit length.
    fn correct_inclination(&mut self, accel_mps2: Vector3) -> Option<Vector3> {
        let gravity = self.gravity.feed(self.gyro_turned.rotate(accel_mps2));
        let level = self.inclination.rotate(gravity);
        let inverse_norm = scalar::inverse_sqrt(vector::dot(level, level));
        if inverse_norm == 0.0 {
            return None;
        }
        let level = vector::scale(level, inverse_norm);
        let [x, y, z] = level;
        let w = scalar::sqrt((z + 1.0) / 2.0);
        let correction = if w > 1e-3 {
            Quaternion {
                w,
                x: 0.5 * y / w,
                y: -0.5 * x / w,
                z: 0.0,
            }
        } else {
            // Upside down: half a turn about any level axis.
            Quaternion {
                w: 0.0,
                x: 1.0,
                y: 0.0,
                z: 0.0,
            }
        };
        self.inclination = correction.after(self.inclination).normalised();
        Some(level)
    }

    pub fn feed_mag(&mut self, mag_ut: Vector3) {
        let level_mag = self.level().rotate(mag_ut);
        self.heading.correct(level_mag, self.rest.smooth_rate_rps());
    }

    /// Body → ENU, carried `ahead_s` past the last sample with its rate.
    pub fn orientation(&self, ahead_s: f32) -> Quaternion {
        self.heading
            .turn()
            .after(self.level())
            .after(step_rotation(self.rate_rps, ahead_s))
    }

    pub const fn bias_rps(&self) -> Vector3 {
        self.bias.bias_rps()
    }

    /// The offset was taken out of the samples elsewhere.
    pub fn restart_bias(&mut self) {
        self.bias.restart_at_zero();
        self.rest.reset();
    }

    /// After a gap in the samples: keeps attitude and offset, forgets all smoothed values.
    pub fn restart_smoothing(&mut self) {
        self.gravity.reset();
        self.rest.reset();
        self.bias.forget_motion();
    }

    fn level(&self) -> Quaternion {
        self.inclination.after(self.gyro_turned)
    }
}

fn step_rotation(rate_rps: Vector3, dt_s: f32) -> Quaternion {
    let angle = vector::scale(rate_rps, dt_s);
    let length = vector::norm(angle);
    if length > MAX_STEP_RAD {
        Quaternion::from_small_rotation(vector::scale(angle, MAX_STEP_RAD / length))
    } else {
        Quaternion::from_small_rotation(angle)
    }
}
