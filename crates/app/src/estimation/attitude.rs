//! Attitude, gyro bias and gyro misalignment from gyro, accelerometer and magnetometer.

mod covariance;
mod error_state;
mod error_state_filter;
mod prediction;
mod rest;
#[cfg(test)]
mod tests;
mod window;

use self::{
    covariance::INITIAL_ANGLE,
    error_state::{BIAS, HEADING},
    error_state_filter::{ErrorStateFilter, Measurements},
    rest::RestDetector,
    window::Window,
};
use super::{magnetic::MagneticHeading, measurement::Measurement, strapdown::Strapdown};
use crate::math::{Quaternion, Vector3, scalar, vector};

const DEG: f32 = 1.0_f32.to_radians();
const GRAVITY_MPS2: f32 = 9.806_65;
/// Noise of the mean rate of a window at rest, (°/s)²·s.
const REST_BIAS_NOISE: f32 = (0.03 * DEG) * (0.03 * DEG);
/// Gate on a steady rate at rest: one that differs from the bias by more than 0.4 °/s and four standard deviations is a
/// slow rotation, whatever the accelerometer shows.
const REST_GATE_RPS: f32 = 0.4 * DEG;
const REST_GATE_SIGMA2: f32 = 16.0;
/// Noise of the zero-velocity update at rest, and on legs whose wheels stand, (m/s)².
const REST_SPEED_NOISE: f32 = 0.05 * 0.05;
/// Noise of the pseudo-measurement that the velocity is zero in the mean, (m/s)²·s.
const SPEED_NOISE: f32 = 0.2 * 0.2;
/// That noise grows with acceleration and velocity, per (m/s²)² and per (m/s)².
const SPEED_NOISE_PER_ACCEL2: f32 = 0.25;
const SPEED_NOISE_PER_SPEED2: f32 = 10.0;
/// Limit of the velocity in that noise, (m/s)²: a wrong attitude must not excuse itself by a velocity that no robot has.
const MAX_SPEED2: f32 = 1.0;
/// While the bias variances add up to more than (1 °/s)², the first rest resets the whole filter.
const UNKNOWN_BIAS: f32 = (1.0 * DEG) * (1.0 * DEG);
/// Square of the cosine of 30°.
const MIN_UPRIGHT_COS2: f32 = 0.75;
/// Variance of the bias after a calibration, (0.1 °/s)².
const CALIBRATED_BIAS_VARIANCE: f32 = (0.1 * DEG) * (0.1 * DEG);
/// A specific force beyond this is an impact and adds velocity noise as a saturated accelerometer does. Hands that move
/// the robot reach 50 m/s².
const IMPACT_MPS2: f32 = 60.0;
/// Rate that may be lost while the gyro is saturated, one standard deviation. Impacts rotate a robot by up to 3500 °/s, of
/// which the gyro shows 2000.
const LOST_RATE_RPS: f32 = 1_500.0 * DEG;
/// The tilt is known if its variance is below (2°)².
const KNOWN_TILT: f32 = (2.0 * DEG) * (2.0 * DEG);
/// Quiet windows in a row that level an unknown tilt.
const LEVELLING_WINDOWS: u8 = 3;
/// Their force must be within this of gravity.
const MAX_GRAVITY_ERROR_MPS2: f32 = 0.3;

/// Which axes were saturated during a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Saturation {
    /// Any axis of accelerometer or gyro.
    pub any: bool,
    /// Time for which each body axis of the gyro was saturated, ms.
    pub gyro_ms: [u8; 3],
}

/// What carries the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Footing {
    /// Anything: it may rest.
    Any,
    /// Legs that balance it. It never rests, and turns so slowly at times that this would pass for a gyro bias.
    Legs,
    /// The same, and its wheels stand.
    StandingLegs,
}

/// The attitude filter: strapdown integration, corrected by an error-state Kalman filter after each window.
#[derive(Clone, Debug)]
pub(super) struct AttitudeFilter {
    strapdown: Strapdown,
    window: Window,
    filter: ErrorStateFilter,
    rest: RestDetector,
    magnetic: MagneticHeading,
    aligned: bool,
    /// Rotation lost to gyro saturation in this window, if any; see `Covariance::add_lost_rotation`.
    lost_rotation_rad: Option<[Vector3; 3]>,
    /// The tilt is unknown until a rest or some motion shows it.
    tilt_unknown: bool,
    footing: Footing,
    /// The wheels of the legs stood when the last window ended. To stand again would take them longer than a window.
    stood: bool,
}

impl AttitudeFilter {
    pub fn new() -> Self {
        Self {
            strapdown: Strapdown::new(),
            window: Window::new(),
            filter: ErrorStateFilter::new(),
            rest: RestDetector::default(),
            magnetic: MagneticHeading::new(),
            aligned: false,
            lost_rotation_rad: None,
            tilt_unknown: false,
            footing: Footing::Any,
            stood: false,
        }
    }

    /// Sets what carries the body from the next sample on.
    pub const fn set_footing(&mut self, footing: Footing) {
        self.footing = footing;
    }

    /// Takes one IMU sample: the means over the last `dt_s` in body axes. The caller has subtracted the acceleration that
    /// it knows from `accel_mps2`. Returns false if the filter found that it had diverged, and the attitude has jumped.
    #[must_use]
    pub fn feed_imu(
        &mut self,
        gyro_rps: Vector3,
        accel_mps2: Vector3,
        saturation: Saturation,
        dt_s: f32,
    ) -> bool {
        if !self.aligned {
            self.align(accel_mps2);
        }
        let mid_sample = self.strapdown.integrate_rate(gyro_rps, dt_s);
        self.window
            .add_rotation(&mid_sample, gyro_rps, self.strapdown.rate_rps, dt_s);
        let accel_enu = mid_sample.rotation.map(|row| vector::dot(row, accel_mps2));
        self.strapdown.integrate_force(accel_enu, dt_s);
        self.window.add_accel(accel_enu);
        self.rest.feed(gyro_rps, accel_mps2);
        if saturation.gyro_ms != [0; 3] {
            self.add_lost_rotation(&mid_sample.rotation, saturation.gyro_ms);
        }
        if saturation.any || vector::dot(accel_mps2, accel_mps2) > IMPACT_MPS2 * IMPACT_MPS2 {
            self.window.accel_clipped_s += dt_s;
        }
        self.apply_correction();
        if self.window.is_full() {
            self.close_window()
        } else {
            true
        }
    }

    /// Takes the first specific force for up.
    fn align(&mut self, accel_mps2: Vector3) {
        let inverse = scalar::inverse_sqrt(vector::dot(accel_mps2, accel_mps2));
        if inverse == 0.0 {
            return;
        }
        self.strapdown.attitude = Quaternion::levelling(vector::scale(accel_mps2, inverse));
        self.aligned = true;
    }

    fn apply_correction(&mut self) {
        let Some(correction) = self.filter.step() else {
            return;
        };
        let (angle_rad, [east, north]) = correction.propagated_through(&self.window);
        correction.apply_to(&mut self.strapdown.gyro);
        self.strapdown.rotate_world(angle_rad);
        let [vx, vy] = self.strapdown.speed_mps;
        self.strapdown.speed_mps = [vx + east, vy + north];
        self.magnetic.rotate_world(angle_rad);
        if self.tilt_unknown
            && self.lost_rotation_rad.is_none()
            && !self.filter.has_lost_rotation_to_add()
        {
            self.tilt_unknown = self.filter.covariance.attitude_variance().tilt > KNOWN_TILT;
        }
    }

    /// Adds up the rotation that the saturated gyro may have missed.
    #[cold]
    #[inline(never)]
    fn add_lost_rotation(&mut self, to_enu: &[Vector3; 3], saturated_ms: [u8; 3]) {
        let max_rad = saturated_ms.map(|ms| f32::from(ms) * 1e-3 * LOST_RATE_RPS);
        let lost_rotation_rad = self.lost_rotation_rad.get_or_insert_default();
        for (sum, axis) in lost_rotation_rad.iter_mut().zip(to_enu) {
            *sum = vector::add(*sum, vector::multiply(*axis, max_rad));
        }
        let [east, north, _] = *lost_rotation_rad;
        let lost = scalar::max(vector::dot(east, east), vector::dot(north, north));
        if lost + self.filter.covariance.attitude_variance().tilt > KNOWN_TILT {
            self.tilt_unknown = true;
        }
    }

    /// True unless rotation was lost and the tilt has not been found again since.
    pub const fn knows_tilt(&self) -> bool {
        !self.tilt_unknown
    }

    /// Ends the window: detects rest and collects the measurements. Returns false if the filter had diverged.
    fn close_window(&mut self) -> bool {
        let stands_on_legs = self.footing == Footing::StandingLegs;
        if stands_on_legs && !self.stood {
            // What rolling has left of velocity is no error of the tilt. A lost rotation resets it, even one of zero.
            self.lost_rotation_rad.get_or_insert_default();
        }
        self.stood = stands_on_legs;
        if let Some(lost_rotation_rad) = self.lost_rotation_rad.take() {
            self.filter.add_lost_rotation(lost_rotation_rad);
            self.strapdown.speed_mps = [0.0; 2];
        }
        let t = self.window.duration_s;
        let known = self.filter.covariance.attitude_variance();
        let field = self.magnetic.close_window(t, known);
        self.filter
            .covariance
            .add_variances(HEADING, &[field.added_variance_rad2]);
        if self.footing != Footing::Any {
            self.rest.reset();
        }
        let rest = self.rest.close_window(field.body_ut);
        let rest_rate = rest
            .filter(|rest| rest.confirmed || self.passes_bias_gate(rest.rate_rps))
            .map(|rest| rest.rate_rps);
        if let Some(rate_rps) = rest_rate {
            let diverged = self.has_diverged(rate_rps);
            if diverged || self.bias_is_unknown() {
                self.reset_at_rest(rate_rps);
                return !diverged;
            }
        }
        if self.tilt_unknown
            && self.rest.quiet_windows() >= LEVELLING_WINDOWS
            && self.measures_gravity()
        {
            return self.level_at_rest();
        }
        if let Some(error_rad) = field.initial_heading_rad {
            self.align_heading(error_rad);
        }
        let stands = rest_rate.is_some() || stands_on_legs;
        let [east, north] = self.velocity_measurements(stands);
        let bias = rest_rate.map(|rate| self.bias_measurements(rate).map(Some));
        let [x, y, z] = bias.unwrap_or_default();
        let measurements: Measurements = [Some(east), Some(north), field.heading, x, y, z];
        self.filter.begin(&self.window, measurements);
        self.window = Window::new();
        true
    }

    fn bias_is_unknown(&self) -> bool {
        let [x, y, z] = self.filter.covariance.variances(BIAS);
        x + y + z > UNKNOWN_BIAS
    }

    /// The filter is linear and corrects small errors only. At rest a large error of bias or tilt shows.
    fn has_diverged(&self, rest_rate_rps: Vector3) -> bool {
        let bias_error_rps = self.strapdown.gyro.corrected(rest_rate_rps);
        let force = self.window.accel_mps2();
        let [.., up] = force;
        vector::dot(bias_error_rps, bias_error_rps) > UNKNOWN_BIAS
            || up * up.abs() < MIN_UPRIGHT_COS2 * vector::dot(force, force)
    }

    /// Restarts the filter: rest gives bias and tilt, the field gives the heading.
    #[cold]
    #[inline(never)]
    fn reset_at_rest(&mut self, rate_rps: Vector3) {
        let bias_error_rps = self.strapdown.gyro.corrected(rate_rps);
        let bias_rps = &mut self.strapdown.gyro.bias_rps;
        *bias_rps = vector::add(*bias_rps, bias_error_rps);
        self.level();
        self.filter.reset();
        self.filter.reset_bias(CALIBRATED_BIAS_VARIANCE);
        self.magnetic = MagneticHeading::new();
    }

    /// Rotates the attitude so that the window's mean force points up, and ends the window. Returns the cosine of the
    /// angle.
    fn level(&mut self) -> f32 {
        let force = self.window.accel_mps2();
        let up = vector::scale(force, scalar::inverse_sqrt(vector::dot(force, force)));
        let levelling = Quaternion::levelling(up);
        self.strapdown.attitude = levelling.after(self.strapdown.attitude).normalised();
        self.strapdown.speed_mps = [0.0; 2];
        self.window = Window::new();
        self.lost_rotation_rad = None;
        self.tilt_unknown = false;
        let [.., cosine] = up;
        cosine
    }

    fn measures_gravity(&self) -> bool {
        let error_mps2 = vector::norm(self.window.accel_mps2()) - GRAVITY_MPS2;
        error_mps2.abs() < MAX_GRAVITY_ERROR_MPS2
    }

    /// Levels the attitude after rotation was lost. The heading becomes less certain by the same angle. Returns false if
    /// that angle was large.
    #[cold]
    #[inline(never)]
    fn level_at_rest(&mut self) -> bool {
        let cosine = self.level();
        // The square of the chord stands for that of the angle.
        self.filter.reset_tilt(2.0 - 2.0 * cosine);
        self.magnetic.discard_world_frame();
        cosine > 0.0 && cosine * cosine > MIN_UPRIGHT_COS2
    }

    fn passes_bias_gate(&self, rate_rps: Vector3) -> bool {
        let error_rps = self.strapdown.gyro.corrected(rate_rps);
        error_rps
            .iter()
            .zip(self.filter.covariance.variances(BIAS))
            .all(|(error, variance)| {
                error * error < REST_GATE_RPS * REST_GATE_RPS + REST_GATE_SIGMA2 * variance
            })
    }

    /// Zero-angular-rate update: at rest the corrected rate is the error of the bias.
    fn bias_measurements(&self, rest_rate_rps: Vector3) -> [Measurement; 3] {
        let variance = REST_BIAS_NOISE / self.window.duration_s;
        self.strapdown
            .gyro
            .corrected(rest_rate_rps)
            .map(|innovation| Measurement {
                innovation,
                variance,
            })
    }

    /// Zero-velocity update: exact while the robot stands, else the pseudo-measurement that the velocity is zero in the mean.
    fn velocity_measurements(&self, stands: bool) -> [Measurement; 2] {
        let t = self.window.duration_s;
        let [ax, ay, az] = self.window.accel_mps2();
        let free_mps2 = [ax, ay, az - GRAVITY_MPS2];
        let variance = if stands {
            REST_SPEED_NOISE
        } else {
            let [vx, vy] = self.strapdown.speed_mps;
            let motion = SPEED_NOISE_PER_ACCEL2 * vector::dot(free_mps2, free_mps2)
                + SPEED_NOISE_PER_SPEED2 * scalar::min(vx * vx + vy * vy, MAX_SPEED2);
            SPEED_NOISE * (1.0 + motion) / t
        };
        self.strapdown.speed_mps.map(|speed_mps| Measurement {
            innovation: -speed_mps,
            variance,
        })
    }

    /// Takes a magnetometer sample in body axes. `ahead_s` is the time from the last IMU sample to it, negative if it is
    /// the older one.
    pub fn feed_mag(&mut self, mag_ut: Vector3, ahead_s: f32) {
        if self.aligned
            && let Some(error_rad) = self.magnetic.feed(mag_ut, &self.strapdown, ahead_s)
        {
            self.align_heading(error_rad);
        }
    }

    #[cold]
    #[inline(never)]
    fn align_heading(&mut self, error_rad: f32) {
        // In two steps, because it may be half a turn.
        self.strapdown.rotate_world([0.0, 0.0, 0.5 * error_rad]);
        self.strapdown.rotate_world([0.0, 0.0, 0.5 * error_rad]);
        self.magnetic.discard_world_frame();
    }

    /// Attitude (body → ENU) `ahead_s` after the last sample, extrapolated with its rate.
    pub fn orientation(&self, ahead_s: f32) -> Quaternion {
        self.strapdown.attitude_at(ahead_s)
    }

    /// Angular rate of the last sample in body axes, corrected by the gyro model.
    pub const fn rate_rps(&self) -> Vector3 {
        self.strapdown.rate_rps
    }

    /// Gyro bias in body axes.
    pub const fn bias_rps(&self) -> Vector3 {
        self.strapdown.gyro.bias_rps
    }

    /// Sets the bias to zero, after a calibration has removed it from the samples.
    pub fn reset_bias(&mut self) {
        self.strapdown.gyro.bias_rps = [0.0; 3];
        self.filter.reset_bias(CALIBRATED_BIAS_VARIANCE);
        self.rest.reset();
    }

    /// Goes on after a gap in the samples. Attitude and gyro model stay, with a larger variance of the attitude. All sums
    /// of the current window are dropped.
    pub fn restart_after_gap(&mut self) {
        self.window = Window::new();
        self.rest.reset();
        self.magnetic.discard_window();
        self.filter.covariance.add_variances(0, &[INITIAL_ANGLE; 3]);
        self.tilt_unknown = self.aligned;
    }
}
