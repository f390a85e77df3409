//! Attitude, gyro bias and gyro misalignment from gyro, accelerometer and magnetometer.

mod covariance;
mod error_filter;
mod forecast;
mod rest;
mod rows;
mod strapdown;
#[cfg(test)]
mod tests;
mod window;

use self::{
    covariance::{BIAS, FIRST_ANGLE, UP},
    error_filter::{ErrorFilter, Findings},
    rest::RestDetector,
    window::Window,
};
pub(super) use self::{error_filter::Finding, strapdown::Strapdown};
use super::magnetic::Magnetic;
use crate::math::{Quaternion, Vector3, scalar, vector};

const DEG: f32 = 1.0_f32.to_radians();
const GRAVITY_MPS2: f32 = 9.806_65;
/// Noise of the mean rate of a window at rest, (°/s)²·s.
const REST_BIAS_NOISE: f32 = (0.03 * DEG) * (0.03 * DEG);
/// A steady rate further from the known bias is a slow turn, whatever the accelerometer says: 0.4 °/s and four standard
/// deviations.
const REST_RATE_RPS: f32 = 0.4 * DEG;
const REST_RATE_DEVIATIONS2: f32 = 16.0;
/// Speed of something at rest, (m/s)².
const REST_SPEED_NOISE: f32 = 0.05 * 0.05;
/// What is known of the speed when nothing measures it: about zero in the mean over time, (m/s)²·s …
const SPEED_NOISE: f32 = 0.2 * 0.2;
/// … and less so where acceleration or speed are large, per (m/s²)² and (m/s)².
const SPEED_NOISE_PER_ACCEL2: f32 = 0.25;
const SPEED_NOISE_PER_SPEED2: f32 = 10.0;
/// A wrong attitude must not explain itself by a speed that nothing has, (m/s)².
const MAX_SPEED2: f32 = 1.0;
/// Until the bias is known this well, (1 °/s)², nothing else is either.
const UNKNOWN_BIAS: f32 = (1.0 * DEG) * (1.0 * DEG);
/// Square of the cosine of 30°.
const LEAST_UPRIGHT2: f32 = 0.75;
/// A bias taken out elsewhere leaves this.
const CALIBRATED_BIAS_VARIANCE: f32 = (0.1 * DEG) * (0.1 * DEG);
/// Rate that the gyro may miss while it is at the end of its range.
const CLIPPED_RATE_RPS: f32 = 300.0 * DEG;

/// Which sensors were at the end of their range.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clipped {
    pub accel: bool,
    pub gyro: bool,
}

#[derive(Clone, Debug)]
pub(super) struct AttitudeFilter {
    strapdown: Strapdown,
    window: Window,
    filter: ErrorFilter,
    rest: RestDetector,
    magnetic: Magnetic,
    clipped_s: f32,
    aligned: bool,
}

impl AttitudeFilter {
    pub fn new() -> Self {
        Self {
            strapdown: Strapdown::new(),
            window: Window::new(),
            filter: ErrorFilter::new(),
            rest: RestDetector::default(),
            magnetic: Magnetic::new(),
            clipped_s: 0.0,
            aligned: false,
        }
    }

    /// One IMU sample of the `dt_s` before now. `accel_mps2`: without what the known motion adds. False if it showed that
    /// the attitude so far was wrong: it has jumped.
    #[must_use]
    pub fn feed_imu(
        &mut self,
        gyro_rps: Vector3,
        accel_mps2: Vector3,
        clipped: Clipped,
        dt_s: f32,
    ) -> bool {
        if !self.aligned {
            self.align(accel_mps2);
        }
        let carried = self.strapdown.turn(gyro_rps, dt_s);
        self.window
            .add_turn(&carried, gyro_rps, self.strapdown.rate_rps, dt_s);
        let accel_enu = carried.middle.map(|row| vector::dot(row, accel_mps2));
        self.strapdown.accelerate(accel_enu, dt_s);
        self.window.add_accel(accel_enu);
        self.rest.feed(gyro_rps, accel_mps2);
        if clipped.gyro {
            self.clipped_s += dt_s;
        }
        if clipped.accel {
            self.window.blind_s += dt_s;
        }
        self.apply_correction();
        if self.window.is_full() {
            self.close_window()
        } else {
            true
        }
    }

    /// The first sample: its acceleration points up.
    fn align(&mut self, accel_mps2: Vector3) {
        let inverse = scalar::inverse_sqrt(vector::dot(accel_mps2, accel_mps2));
        if inverse == 0.0 {
            return;
        }
        self.strapdown.attitude = Quaternion::lifting(vector::scale(accel_mps2, inverse));
        self.aligned = true;
    }

    fn apply_correction(&mut self) {
        let Some(correction) = self.filter.continue_work() else {
            return;
        };
        let (angle_rad, [east, north]) = correction.carried_through(&self.window);
        correction.add_to(&mut self.strapdown.gyro);
        self.strapdown.tilt(angle_rad);
        let [vx, vy] = self.strapdown.speed_mps;
        self.strapdown.speed_mps = [vx + east, vy + north];
        self.magnetic.tilt(angle_rad);
    }

    fn close_window(&mut self) -> bool {
        if self.clipped_s > 0.0 {
            let angle_rad = CLIPPED_RATE_RPS * self.clipped_s;
            self.window.unseen_rad2 += angle_rad * angle_rad;
            self.clipped_s = 0.0;
        }
        let t = self.window.duration_s;
        let field = self.magnetic.close(t, self.filter.covariance.certainty());
        self.filter.covariance.doubt(UP, &[field.doubt]);
        let rest_rate = self
            .rest
            .close(field.body_ut)
            .filter(|rate| self.may_be_bias(*rate));
        if let Some(rate_rps) = rest_rate {
            let lost = self.is_lost(rate_rps);
            if lost || self.bias_is_unknown() {
                self.start_from_rest(rate_rps);
                return !lost;
            }
        }
        if let Some(turn_rad) = field.first_heading_rad {
            self.turn_to_north(turn_rad);
        }
        let [east, north] = self.speed_findings(rest_rate.is_some());
        let bias = rest_rate.map(|rate| self.bias_findings(rate).map(Some));
        let [x, y, z] = bias.unwrap_or_default();
        let findings: Findings = [Some(east), Some(north), field.heading, x, y, z];
        self.filter.begin(&self.window, findings);
        self.window = Window::new();
        true
    }

    fn bias_is_unknown(&self) -> bool {
        let [x, y, z] = self.filter.covariance.variances(BIAS);
        x + y + z > UNKNOWN_BIAS
    }

    /// The filter corrects small errors. Is it far off at rest: in its bias, or from upright?
    fn is_lost(&self, rest_rate_rps: Vector3) -> bool {
        let beyond_rps = self.strapdown.gyro.corrected(rest_rate_rps);
        let force = self.window.accel_mps2();
        let [.., up] = force;
        vector::dot(beyond_rps, beyond_rps) > UNKNOWN_BIAS
            || up * up.abs() < LEAST_UPRIGHT2 * vector::dot(force, force)
    }

    /// What went wrong so far is forgotten: rest tells bias and inclination, the field the heading.
    #[cold]
    #[inline(never)]
    fn start_from_rest(&mut self, rate_rps: Vector3) {
        let beyond_rps = self.strapdown.gyro.corrected(rate_rps);
        let bias_rps = &mut self.strapdown.gyro.bias_rps;
        *bias_rps = vector::add(*bias_rps, beyond_rps);
        let force = self.window.accel_mps2();
        let up = vector::scale(force, scalar::inverse_sqrt(vector::dot(force, force)));
        let righting = Quaternion::lifting(up);
        self.strapdown.attitude = righting.after(self.strapdown.attitude).normalised();
        self.strapdown.speed_mps = [0.0; 2];
        self.window = Window::new();
        self.filter.restart();
        self.filter.replace_bias(CALIBRATED_BIAS_VARIANCE);
        self.magnetic = Magnetic::new();
    }

    fn may_be_bias(&self, rate_rps: Vector3) -> bool {
        let beyond = self.strapdown.gyro.corrected(rate_rps);
        beyond
            .iter()
            .zip(self.filter.covariance.variances(BIAS))
            .all(|(rate, variance)| {
                rate * rate < REST_RATE_RPS * REST_RATE_RPS + REST_RATE_DEVIATIONS2 * variance
            })
    }

    fn bias_findings(&self, rest_rate_rps: Vector3) -> [Finding; 3] {
        let noise = REST_BIAS_NOISE / self.window.duration_s;
        self.strapdown
            .gyro
            .corrected(rest_rate_rps)
            .map(|innovation| Finding { innovation, noise })
    }

    fn speed_findings(&self, resting: bool) -> [Finding; 2] {
        let t = self.window.duration_s;
        let [ax, ay, az] = self.window.accel_mps2();
        let felt = [ax, ay, az - GRAVITY_MPS2];
        let noise = if resting {
            REST_SPEED_NOISE
        } else {
            let [vx, vy] = self.strapdown.speed_mps;
            let moved = SPEED_NOISE_PER_ACCEL2 * vector::dot(felt, felt)
                + SPEED_NOISE_PER_SPEED2 * scalar::min(vx * vx + vy * vy, MAX_SPEED2);
            SPEED_NOISE * (1.0 + moved) / t
        };
        self.strapdown.speed_mps.map(|speed_mps| Finding {
            innovation: -speed_mps,
            noise,
        })
    }

    /// `ahead_s`: when the field was measured, after the last IMU sample; negative: before.
    pub fn feed_mag(&mut self, mag_ut: Vector3, ahead_s: f32) {
        if self.aligned
            && let Some(turn_rad) = self.magnetic.feed(mag_ut, &self.strapdown, ahead_s)
        {
            self.turn_to_north(turn_rad);
        }
    }

    #[cold]
    #[inline(never)]
    fn turn_to_north(&mut self, turn_rad: f32) {
        // In two steps: it may be half a turn.
        self.strapdown.tilt([0.0, 0.0, 0.5 * turn_rad]);
        self.strapdown.tilt([0.0, 0.0, 0.5 * turn_rad]);
        self.magnetic.forget_world();
    }

    /// Body → ENU, carried `ahead_s` past the last sample with its rate.
    pub fn orientation(&self, ahead_s: f32) -> Quaternion {
        self.strapdown.attitude_at(ahead_s)
    }

    /// Of the last sample, without the errors of the gyro.
    pub const fn rate_rps(&self) -> Vector3 {
        self.strapdown.rate_rps
    }

    pub const fn bias_rps(&self) -> Vector3 {
        self.strapdown.gyro.bias_rps
    }

    /// The offset was taken out of the samples elsewhere.
    pub fn restart_bias(&mut self) {
        self.strapdown.gyro.bias_rps = [0.0; 3];
        self.filter.replace_bias(CALIBRATED_BIAS_VARIANCE);
        self.rest.restart();
    }

    /// After a gap in the samples: keeps attitude and gyro model, doubts the attitude, forgets all that was adding up.
    pub fn restart_after_gap(&mut self) {
        self.window = Window::new();
        self.clipped_s = 0.0;
        self.rest.restart();
        self.magnetic.restart();
        self.filter.covariance.doubt(0, &[FIRST_ANGLE; 3]);
    }
}
