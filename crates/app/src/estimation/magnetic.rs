//! Heading from the magnetometer, and whether its field can be trusted.

mod delay;
mod disturbance;
mod hard_iron;
#[cfg(test)]
mod tests;

use self::{delay::DelayFilter, disturbance::DisturbanceDetector, hard_iron::HardIron};
use super::{attitude_variance::AttitudeVariance, measurement::Measurement, strapdown::Strapdown};
use crate::math::{Vector3, scalar, vector};

const DEG: f32 = 1.0_f32.to_radians();
/// Noise of a heading, rad²·s. Indoors the field is off by some degrees for some seconds at a time.
const HEADING_NOISE: f32 = (20.0 * DEG) * (20.0 * DEG);
/// While the variance of the heading is larger than this, each window counts as a measurement with `COARSE_NOISE`.
const COARSE_HEADING: f32 = (5.0 * DEG) * (5.0 * DEG);
const COARSE_NOISE: f32 = (10.0 * DEG) * (10.0 * DEG);
/// Variance of the disturbance in a building, rad². Three times its standard deviation is a magnet.
const DISTURBANCE: f32 = (5.0 * DEG) * (5.0 * DEG);
/// An innovation beyond three standard deviations is rejected.
const GATE_SIGMA2: f32 = 9.0;
/// An innovation beyond two is clipped to two.
const CLIP_SIGMA2: f32 = 4.0;
/// Longest time for which a contradicting field is rejected. It is rejected for as long as the field was accepted before,
/// but no longer than this.
const MAX_REJECTION_S: f32 = 60.0;
/// Largest variance of the tilt at which the field tells heading and dip.
const MAX_TILT: f32 = (3.0 * DEG) * (3.0 * DEG);
/// A field with less horizontal strength than this has no direction.
const MIN_HORIZONTAL_UT: f32 = 5.0;
/// The earth's field has 22 to 67 µT. A field stronger than this is never accepted.
const MAX_FIELD_UT: f32 = 120.0;

/// Turns magnetometer samples into heading measurements, one a window.
#[derive(Clone, Debug)]
pub(super) struct MagneticHeading {
    delay: DelayFilter,
    hard_iron: HardIron,
    disturbance: DisturbanceDetector,
    sums: Sums,
    /// The first sample has aligned the heading roughly.
    has_sample: bool,
    /// A window has aligned the heading.
    aligned: bool,
    accepted_s: f32,
    rejected_s: f32,
}

/// Sums over one window.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    field_enu_ut: Vector3,
    field_body_ut: Vector3,
    rows: [Vector3; 3],
    rate_rps: f32,
    count: u8,
}

/// What the field samples of one window show.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeadingReport {
    /// Mean field in body axes, as measured.
    pub body_ut: Option<Vector3>,
    /// Heading error of a heading that was unknown before: to be corrected at once.
    pub initial_heading_rad: Option<f32>,
    /// Measurement of the heading error.
    pub heading: Option<Measurement>,
    /// Variance to add to the heading, rad²: the field has contradicted it for too long.
    pub added_variance_rad2: f32,
}

impl MagneticHeading {
    pub fn new() -> Self {
        Self {
            delay: DelayFilter::new(),
            hard_iron: HardIron::new(),
            disturbance: DisturbanceDetector::new(),
            sums: Sums::default(),
            has_sample: false,
            aligned: false,
            accepted_s: 0.0,
            rejected_s: 0.0,
        }
    }

    /// Adds a sample in body axes, whose time stamp is `ahead_s` after the last IMU sample. Returns the heading error that
    /// the very first sample shows.
    pub fn feed(&mut self, mag_ut: Vector3, strapdown: &Strapdown, ahead_s: f32) -> Option<f32> {
        let field_ut = vector::sub(mag_ut, self.hard_iron.compensation_ut());
        let attitude = strapdown.attitude_at(ahead_s - self.delay.seconds());
        let rows = attitude.rotation_matrix();
        let field_enu = rows.map(|row| vector::dot(row, field_ut));
        if !self.has_sample {
            self.has_sample = true;
            let [x, y, _] = field_enu;
            return Some(scalar::atan2(x, y));
        }
        let rate_enu = rows.map(|row| vector::dot(row, strapdown.rate_rps));
        self.delay.update(field_enu, rate_enu);
        let sums = &mut self.sums;
        sums.field_enu_ut = vector::add(sums.field_enu_ut, field_enu);
        sums.field_body_ut = vector::add(sums.field_body_ut, mag_ut);
        for (sum, row) in sums.rows.iter_mut().zip(rows) {
            *sum = vector::add(*sum, row);
        }
        sums.rate_rps = vector::norm(strapdown.rate_rps);
        sums.count = sums.count.saturating_add(1);
        None
    }

    /// Ends a window that lasted `window_s`. `known` is the variance of the attitude.
    pub fn close_window(&mut self, window_s: f32, known: AttitudeVariance) -> HeadingReport {
        let sums = core::mem::take(&mut self.sums);
        let mut report = HeadingReport::default();
        if sums.count == 0 {
            return report;
        }
        let share = 1.0 / f32::from(sums.count);
        report.body_ut = Some(vector::scale(sums.field_body_ut, share));
        let field_enu = vector::scale(sums.field_enu_ut, share);
        let [x, y, vertical_ut] = field_enu;
        let horizontal2 = x * x + y * y;
        let norm2 = horizontal2 + vertical_ut * vertical_ut;
        if horizontal2 < MIN_HORIZONTAL_UT * MIN_HORIZONTAL_UT
            || norm2 > MAX_FIELD_UT * MAX_FIELD_UT
        {
            return report;
        }
        // The horizontal field points north. It is rotated from +y by −atan2(x, y).
        let error_rad = scalar::atan2(x, y);
        if !self.aligned {
            self.aligned = known.tilt < MAX_TILT;
            report.initial_heading_rad = Some(error_rad);
            return report;
        }
        if known.tilt > MAX_TILT {
            return report;
        }
        let horizontal_ut = scalar::sqrt(horizontal2);
        let rows = sums.rows.map(|row| vector::scale(row, share));
        self.hard_iron
            .update(field_enu, horizontal_ut, rows, window_s);
        let norm_ut = scalar::sqrt(norm2);
        let disturbed = self
            .disturbance
            .detect(norm_ut, vertical_ut, sums.rate_rps, window_s);
        let innovation_variance = DISTURBANCE + known.heading;
        if disturbed || error_rad * error_rad > GATE_SIGMA2 * innovation_variance {
            self.reject(window_s, error_rad, &mut report);
        } else {
            self.accepted_s = scalar::min(self.accepted_s + window_s, MAX_REJECTION_S);
            self.rejected_s = scalar::max(self.rejected_s - 2.0 * window_s, 0.0);
            report.heading = Some(heading_measurement(
                error_rad,
                innovation_variance,
                known.heading,
                window_s,
            ));
        }
        report
    }

    fn reject(&mut self, window_s: f32, error_rad: f32, report: &mut HeadingReport) {
        self.rejected_s += window_s;
        if self.rejected_s > self.accepted_s {
            report.added_variance_rad2 = error_rad * error_rad;
            self.rejected_s = 0.0;
            self.accepted_s = 0.0;
            self.disturbance = DisturbanceDetector::new();
        }
    }

    /// Rotates what is stored in ENU by a rotation vector in ENU, as the attitude was.
    pub fn rotate_world(&mut self, by_rad: Vector3) {
        let field = self.sums.field_enu_ut;
        self.sums.field_enu_ut = vector::add(field, vector::cross(by_rad, field));
        self.delay.rotate_world(by_rad);
    }

    /// Drops what is stored in ENU, after the heading has jumped.
    pub fn discard_world_frame(&mut self) {
        self.sums = Sums::default();
        self.delay.reset_reference();
    }

    #[cfg(test)]
    pub fn delay_s(&self) -> f32 {
        self.delay.seconds()
    }

    /// Drops the sums of the current window, after samples were lost.
    pub fn discard_window(&mut self) {
        self.sums = Sums::default();
    }
}

/// The measurement from a heading error that has passed the gate. `variance` is that of the heading.
fn heading_measurement(
    error_rad: f32,
    innovation_variance: f32,
    variance: f32,
    window_s: f32,
) -> Measurement {
    let mut innovation = error_rad;
    if error_rad * error_rad > CLIP_SIGMA2 * innovation_variance {
        let limit = scalar::sqrt(CLIP_SIGMA2 * innovation_variance);
        innovation = if error_rad > 0.0 { limit } else { -limit };
    }
    let noise = if variance > COARSE_HEADING {
        COARSE_NOISE
    } else {
        HEADING_NOISE / window_s
    };
    Measurement {
        innovation,
        variance: noise,
    }
}
