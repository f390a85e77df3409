//! Detection of magnetic disturbances by norm and dip of the field.
//!
//! Method and thresholds are those of VQF (Laidig and Seel, 2023, section 3.6), except that a new reference is adopted
//! later.

use crate::math::scalar;

/// Greatest difference from the reference norm, as a share of it.
const MAX_NORM_ERROR: f32 = 0.1;
const MAX_DIP_ERROR_RAD: f32 = 10.0_f32.to_radians();
/// Time constant with which the reference follows an undisturbed field.
const REFERENCE_S: f32 = 20.0;
/// A field must match the reference for this long before a disturbance is over.
const MIN_UNDISTURBED_S: f32 = 0.5;
/// Time in motion after which another steady field becomes the reference.
const ADOPT_S: f32 = 60.0;
/// The same for the first reference.
const ADOPT_FIRST_S: f32 = 5.0;
/// Least angular rate that counts as motion.
const MIN_MOTION_RPS: f32 = 20.0_f32.to_radians();

#[derive(Clone, Copy, Debug, Default)]
struct NormAndDip {
    norm_ut: f32,
    /// Angle below the horizon.
    dip_rad: f32,
}

impl NormAndDip {
    fn matches(self, reference: Self) -> bool {
        (self.norm_ut - reference.norm_ut).abs() < MAX_NORM_ERROR * reference.norm_ut
            && (self.dip_rad - reference.dip_rad).abs() < MAX_DIP_ERROR_RAD
    }

    fn low_pass(&mut self, other: Self, share: f32) {
        self.norm_ut += share * (other.norm_ut - self.norm_ut);
        self.dip_rad += share * (other.dip_rad - self.dip_rad);
    }
}

/// Compares the field with a reference, and adopts a new reference when the field has been another one for long enough.
#[derive(Clone, Debug)]
pub(super) struct DisturbanceDetector {
    reference: Option<NormAndDip>,
    /// The field that may become the next reference.
    candidate: NormAndDip,
    candidate_s: f32,
    undisturbed_s: f32,
    disturbed: bool,
}

impl DisturbanceDetector {
    pub const fn new() -> Self {
        Self {
            reference: None,
            candidate: NormAndDip {
                norm_ut: 0.0,
                dip_rad: 0.0,
            },
            candidate_s: 0.0,
            undisturbed_s: 0.0,
            disturbed: false,
        }
    }

    /// Takes the field of a window: its norm, its vertical part `up_ut`, and the robot's angular rate. Returns true while
    /// the field does not match the reference.
    pub fn detect(&mut self, norm_ut: f32, up_ut: f32, rate_rps: f32, window_s: f32) -> bool {
        let dip_rad = -scalar::asin(up_ut / norm_ut);
        let field = NormAndDip { norm_ut, dip_rad };
        self.compare_with_reference(field, window_s);
        self.update_candidate(field, rate_rps, window_s);
        self.disturbed
    }

    fn compare_with_reference(&mut self, field: NormAndDip, window_s: f32) {
        let share = window_s / REFERENCE_S;
        match &mut self.reference {
            Some(reference) if field.matches(*reference) => {
                self.undisturbed_s += window_s;
                if self.undisturbed_s >= MIN_UNDISTURBED_S {
                    self.disturbed = false;
                    reference.low_pass(field, share);
                }
            }
            Some(_) => {
                self.undisturbed_s = 0.0;
                self.disturbed = true;
            }
            None => {}
        }
    }

    fn update_candidate(&mut self, field: NormAndDip, rate_rps: f32, window_s: f32) {
        if !field.matches(self.candidate) {
            self.candidate_s = 0.0;
            self.candidate = field;
            return;
        }
        if rate_rps >= MIN_MOTION_RPS {
            self.candidate_s += window_s;
        }
        self.candidate.low_pass(field, window_s / REFERENCE_S);
        let needed_s = match self.reference {
            Some(_) => ADOPT_S,
            None => ADOPT_FIRST_S,
        };
        if (self.disturbed || self.reference.is_none()) && self.candidate_s >= needed_s {
            self.reference = Some(self.candidate);
            self.disturbed = false;
            self.undisturbed_s = MIN_UNDISTURBED_S;
        }
    }
}

#[cfg(test)]
mod tests;
