//! Where magnetic north is, and whether the magnetometer can be believed.

mod carried_magnet;
mod delay;
mod field_monitor;
#[cfg(test)]
mod tests;

use self::{carried_magnet::CarriedMagnet, delay::Delay, field_monitor::FieldMonitor};
use super::attitude::{Finding, Strapdown};
use crate::math::{Vector3, scalar, vector};

const DEG: f32 = 1.0_f32.to_radians();
/// The field indoors is some degrees off for some seconds at a time, (rad)²·s.
const HEADING_NOISE: f32 = (20.0 * DEG) * (20.0 * DEG);
/// While the heading is further off than this, headings count as if they were this sure each.
const UNSURE: f32 = (5.0 * DEG) * (5.0 * DEG);
const UNSURE_NOISE: f32 = (10.0 * DEG) * (10.0 * DEG);
/// Buildings turn the field by this; three times that is a magnet.
const PLACE: f32 = (5.0 * DEG) * (5.0 * DEG);
const GATE2: f32 = 9.0;
/// More than this of an innovation is not believed at once.
const CLIP2: f32 = 4.0;
/// A field that contradicts is ignored for as long as it was believed before, but no longer than this.
const MAX_REJECTION_S: f32 = 60.0;
/// The dip says nothing while the inclination is less sure than this.
const MAX_TILT: f32 = (3.0 * DEG) * (3.0 * DEG);
/// A field this steep has no direction.
const MIN_LEVEL_UT: f32 = 5.0;
/// The earth's field has 22 to 67 µT; what is stronger than this is not the earth's, however long it lasts.
const MAX_FIELD_UT: f32 = 120.0;

#[derive(Clone, Debug)]
pub(super) struct Magnetic {
    delay: Delay,
    magnet: CarriedMagnet,
    monitor: FieldMonitor,
    sums: Sums,
    /// North is known, roughly (from one sample) or well.
    seen: bool,
    aligned: bool,
    believed_s: f32,
    rejected_s: f32,
}

/// Of one window.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    field_enu_ut: Vector3,
    field_body_ut: Vector3,
    rows: [Vector3; 3],
    rate_rps: f32,
    count: u8,
}

/// What a window of field samples says.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FieldReport {
    /// Mean in body axes.
    pub body_ut: Option<Vector3>,
    /// North was not known before: turn there at once.
    pub first_heading_rad: Option<f32>,
    pub heading: Option<Finding>,
    /// What was believed so far contradicts what is measured for too long, rad².
    pub doubt: f32,
}

/// How sure the attitude is, rad².
#[derive(Clone, Copy, Debug)]
pub(super) struct Certainty {
    pub tilt: f32,
    pub heading: f32,
}

impl Magnetic {
    pub fn new() -> Self {
        Self {
            delay: Delay::new(),
            magnet: CarriedMagnet::new(),
            monitor: FieldMonitor::new(),
            sums: Sums::default(),
            seen: false,
            aligned: false,
            believed_s: 0.0,
            rejected_s: 0.0,
        }
    }

    /// `ahead_s`: when it was measured, after the last IMU sample. The turn to north, of the very first sample.
    pub fn feed(&mut self, mag_ut: Vector3, strapdown: &Strapdown, ahead_s: f32) -> Option<f32> {
        let field_ut = vector::sub(mag_ut, self.magnet.field_ut());
        let attitude = strapdown.attitude_at(ahead_s - self.delay.seconds());
        let rows = attitude.rotation_matrix();
        let field_enu = rows.map(|row| vector::dot(row, field_ut));
        if !self.seen {
            self.seen = true;
            let [x, y, _] = field_enu;
            return Some(scalar::atan2(x, y));
        }
        let rate_enu = rows.map(|row| vector::dot(row, strapdown.rate_rps));
        self.delay.learn(field_enu, rate_enu);
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

    /// Ends a window that lasted `window_s`.
    pub fn close(&mut self, window_s: f32, known: Certainty) -> FieldReport {
        let sums = core::mem::take(&mut self.sums);
        let mut report = FieldReport::default();
        if sums.count == 0 {
            return report;
        }
        let share = 1.0 / f32::from(sums.count);
        report.body_ut = Some(vector::scale(sums.field_body_ut, share));
        let field_enu = vector::scale(sums.field_enu_ut, share);
        let [x, y, up_ut] = field_enu;
        let level2 = x * x + y * y;
        let norm2 = level2 + up_ut * up_ut;
        if level2 < MIN_LEVEL_UT * MIN_LEVEL_UT || norm2 > MAX_FIELD_UT * MAX_FIELD_UT {
            return report;
        }
        // North is where the level part points: from +y by −atan2(x, y).
        let error_rad = scalar::atan2(x, y);
        if !self.aligned {
            self.aligned = known.tilt < MAX_TILT;
            report.first_heading_rad = Some(error_rad);
            return report;
        }
        if known.tilt > MAX_TILT {
            return report;
        }
        let level_ut = scalar::sqrt(level2);
        let rows = sums.rows.map(|row| vector::scale(row, share));
        self.magnet.observe(field_enu, level_ut, rows, window_s);
        let norm_ut = scalar::sqrt(norm2);
        let disturbed = self
            .monitor
            .disturbed(norm_ut, up_ut, sums.rate_rps, window_s);
        let spread = PLACE + known.heading;
        if disturbed || error_rad * error_rad > GATE2 * spread {
            self.reject(window_s, error_rad, &mut report);
        } else {
            self.believed_s = scalar::min(self.believed_s + window_s, MAX_REJECTION_S);
            self.rejected_s = scalar::max(self.rejected_s - 2.0 * window_s, 0.0);
            report.heading = Some(heading(error_rad, spread, known.heading, window_s));
        }
        report
    }

    fn reject(&mut self, window_s: f32, error_rad: f32, report: &mut FieldReport) {
        self.rejected_s += window_s;
        if self.rejected_s > self.believed_s {
            report.doubt = error_rad * error_rad;
            self.rejected_s = 0.0;
            self.believed_s = 0.0;
            self.monitor = FieldMonitor::new();
        }
    }

    /// The world turns under the robot by a rotation vector in ENU.
    pub fn tilt(&mut self, by_rad: Vector3) {
        let field = self.sums.field_enu_ut;
        self.sums.field_enu_ut = vector::add(field, vector::cross(by_rad, field));
        self.delay.tilt(by_rad);
    }

    /// The world has another north from now on.
    pub fn forget_world(&mut self) {
        self.sums = Sums::default();
        self.delay.forget_mean();
    }

    #[cfg(test)]
    pub fn delay_s(&self) -> f32 {
        self.delay.seconds()
    }

    /// Samples were lost.
    pub fn restart(&mut self) {
        self.sums = Sums::default();
    }
}

fn heading(error_rad: f32, spread: f32, variance: f32, window_s: f32) -> Finding {
    let mut innovation = error_rad;
    if error_rad * error_rad > CLIP2 * spread {
        let limit = scalar::sqrt(CLIP2 * spread);
        innovation = if error_rad > 0.0 { limit } else { -limit };
    }
    let noise = if variance > UNSURE {
        UNSURE_NOISE
    } else {
        HEADING_NOISE / window_s
    };
    Finding { innovation, noise }
}
