//! Rotation about the vertical from the gyro's own frame to north (VQF section 3.3).

use core::f32::consts::{PI, TAU};

use super::field_monitor::FieldMonitor;
use crate::math::{Quaternion, Vector3, scalar, vector};

const MAG_SAMPLE_S: f32 = 0.02;
const CORRECTION_S: f32 = 9.0;
/// 1 − exp(−T/τ), to second order.
const CORRECTION_SHARE: f32 =
    MAG_SAMPLE_S / CORRECTION_S * (1.0 - MAG_SAMPLE_S / CORRECTION_S / 2.0);
/// A disturbed field is ignored for so long, then followed slowly.
const MAX_REJECTION_S: f32 = 60.0;
const REJECTION_FACTOR: f32 = 2.0;
/// Weaker than any field on earth.
const MIN_FIELD_UT: f32 = 5.0;

#[derive(Clone, Debug)]
pub(super) struct Heading {
    offset_rad: f32,
    turn: Quaternion,
    monitor: FieldMonitor,
    rejected_s: f32,
    /// The first samples count fully, then 1/2, 1/3 …
    initial_share: f32,
}

impl Heading {
    pub fn new() -> Self {
        Self {
            offset_rad: 0.0,
            turn: Quaternion::IDENTITY,
            monitor: FieldMonitor::new(MAG_SAMPLE_S),
            rejected_s: 0.0,
            initial_share: 1.0,
        }
    }

    /// Rotation that brings the level frame into ENU.
    pub const fn turn(&self) -> Quaternion {
        self.turn
    }

    /// `level_mag_ut`: a new sample in the level frame (z up, heading not yet known).
    pub fn correct(&mut self, level_mag_ut: Vector3, rate_rps: f32) {
        let norm_ut = vector::norm(level_mag_ut);
        if norm_ut < MIN_FIELD_UT {
            return;
        }
        let [x, y, z] = level_mag_ut;
        let disturbed = self.monitor.disturbed(norm_ut, z, rate_rps);
        let share = self.share(disturbed);
        // North of the level frame is where the field's level part points: from +y by −atan2(x, y).
        let error_rad = wrapped(scalar::atan2(x, y) - self.offset_rad);
        self.offset_rad = wrapped(self.offset_rad + share * error_rad);
        let (sin, cos) = half_sin_cos(self.offset_rad);
        self.turn = Quaternion::about_z(cos, sin);
    }

    fn share(&mut self, disturbed: bool) -> f32 {
        let mut share = CORRECTION_SHARE;
        if !disturbed {
            self.rejected_s = (self.rejected_s - REJECTION_FACTOR * MAG_SAMPLE_S).max(0.0);
        } else if self.rejected_s <= MAX_REJECTION_S {
            self.rejected_s += MAG_SAMPLE_S;
            share = 0.0;
        } else {
            share /= REJECTION_FACTOR;
        }
        if self.initial_share > 0.0 {
            share = share.max(self.initial_share);
            self.initial_share /= self.initial_share + 1.0;
            if self.initial_share * CORRECTION_S < MAG_SAMPLE_S {
                self.initial_share = 0.0;
            }
        }
        share
    }
}

fn wrapped(angle_rad: f32) -> f32 {
    if angle_rad > PI {
        angle_rad - TAU
    } else if angle_rad < -PI {
        angle_rad + TAU
    } else {
        angle_rad
    }
}

/// sin and cos of half an angle inside ±π.
fn half_sin_cos(angle_rad: f32) -> (f32, f32) {
    let (sin, cos) = scalar::sin_cos_small(angle_rad / 4.0);
    (2.0 * sin * cos, 1.0 - 2.0 * sin * sin)
}
