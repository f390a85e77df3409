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
/// A force beyond this is a blow, after which the speed is known no better than if it had been cut off. People's hands
/// get to 50.
const BLOW_MPS2: f32 = 60.0;
/// Rate beyond the end of the gyro's range, one standard deviation: blows turn a robot by up to 3500 °/s, of which the
/// gyro shows 2000.
const UNSEEN_RPS: f32 = 1_500.0 * DEG;
/// Up is known, and known no more, when it is this sure.
const KNOWN_UP: f32 = (2.0 * DEG) * (2.0 * DEG);
/// Until up is known, so many quiet windows in a row show it, …
const UP_WINDOWS: u8 = 3;
/// … if their force is gravity's within this, m/s².
const UP_FORCE_MPS2: f32 = 0.3;

/// What was at the end of its range.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clipped {
    /// Accelerometer or gyro.
    pub accel: bool,
    /// How long, by axis of the body.
    pub gyro_ms: [u8; 3],
}

#[derive(Clone, Debug)]
pub(super) struct AttitudeFilter {
    strapdown: Strapdown,
    window: Window,
    filter: ErrorFilter,
    rest: RestDetector,
    magnetic: Magnetic,
    aligned: bool,
    /// What the gyro did not see in this window, if anything; see `Covariance::doubt_turn`.
    unseen_rad: Option<[Vector3; 3]>,
    /// Too much was not seen: it takes a rest or some motion to tell where up is.
    up_unknown: bool,
}

impl AttitudeFilter {
    pub fn new() -> Self {
        Self {
            strapdown: Strapdown::new(),
            window: Window::new(),
            filter: ErrorFilter::new(),
            rest: RestDetector::default(),
            magnetic: Magnetic::new(),
            aligned: false,
            unseen_rad: None,
            up_unknown: false,
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
        if clipped.gyro_ms != [0; 3] {
            self.miss_turn(&carried.middle, clipped.gyro_ms);
        }
        if clipped.accel || vector::dot(accel_mps2, accel_mps2) > BLOW_MPS2 * BLOW_MPS2 {
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
        if self.up_unknown && self.unseen_rad.is_none() && self.filter.is_up_to_date() {
            self.up_unknown = self.filter.covariance.certainty().tilt > KNOWN_UP;
        }
    }

    /// The body has turned further than the gyro shows.
    #[cold]
    #[inline(never)]
    fn miss_turn(&mut self, to_enu: &[Vector3; 3], clipped_ms: [u8; 3]) {
        let most_rad = clipped_ms.map(|ms| f32::from(ms) * 1e-3 * UNSEEN_RPS);
        let unseen_rad = self.unseen_rad.get_or_insert_default();
        for (sum, axis) in unseen_rad.iter_mut().zip(to_enu) {
            *sum = vector::add(*sum, vector::multiply(*axis, most_rad));
        }
        let [east, north, _] = *unseen_rad;
        let unseen = scalar::max(vector::dot(east, east), vector::dot(north, north));
        if unseen + self.filter.covariance.certainty().tilt > KNOWN_UP {
            self.up_unknown = true;
        }
    }

    /// Up is known: nothing has happened that the gyro did not see, or it was found again since.
    pub const fn knows_up(&self) -> bool {
        !self.up_unknown
    }

    fn close_window(&mut self) -> bool {
        if let Some(unseen_rad) = self.unseen_rad.take() {
            self.filter.doubt_turn(unseen_rad);
            self.strapdown.speed_mps = [0.0; 2];
        }
        let t = self.window.duration_s;
        let field = self.magnetic.close(t, self.filter.covariance.certainty());
        self.filter.covariance.doubt(UP, &[field.doubt]);
        let rest = self.rest.close(field.body_ut);
        let rest_rate = rest
            .filter(|rest| rest.proven || self.may_be_bias(rest.rate_rps))
            .map(|rest| rest.rate_rps);
        if let Some(rate_rps) = rest_rate {
            let lost = self.is_lost(rate_rps);
            if lost || self.bias_is_unknown() {
                self.start_from_rest(rate_rps);
                return !lost;
            }
        }
        if self.up_unknown && self.rest.quiet_windows() >= UP_WINDOWS && self.feels_gravity() {
            return self.find_up_at_rest();
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
        self.lift();
        self.filter.restart();
        self.filter.replace_bias(CALIBRATED_BIAS_VARIANCE);
        self.magnetic = Magnetic::new();
    }

    /// The attitude turns so that the window's mean force points up; the window ends, and up is known. The cosine of the
    /// angle.
    fn lift(&mut self) -> f32 {
        let force = self.window.accel_mps2();
        let up = vector::scale(force, scalar::inverse_sqrt(vector::dot(force, force)));
        let righting = Quaternion::lifting(up);
        self.strapdown.attitude = righting.after(self.strapdown.attitude).normalised();
        self.strapdown.speed_mps = [0.0; 2];
        self.window = Window::new();
        self.unseen_rad = None;
        self.up_unknown = false;
        let [.., cosine] = up;
        cosine
    }

    fn feels_gravity(&self) -> bool {
        let off_mps2 = vector::norm(self.window.accel_mps2()) - GRAVITY_MPS2;
        off_mps2.abs() < UP_FORCE_MPS2
    }

    /// What the gyro has missed rest makes up for, but for the heading: by so much as up was off that may be too. False
    /// if that was far.
    #[cold]
    #[inline(never)]
    fn find_up_at_rest(&mut self) -> bool {
        let cosine = self.lift();
        // The angle's square, from its chord.
        self.filter.know_up(2.0 - 2.0 * cosine);
        self.magnetic.forget_world();
        cosine > 0.0 && cosine * cosine > LEAST_UPRIGHT2
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
        self.rest.restart();
        self.magnetic.restart();
        self.filter.covariance.doubt(0, &[FIRST_ANGLE; 3]);
        self.up_unknown = self.aligned;
    }
}
