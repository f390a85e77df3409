//! Is this the earth's field? (VQF section 3.6 and its thresholds; a new field is believed later than there)

use crate::math::scalar;

/// Share of the reference strength.
const MAX_NORM_ERROR: f32 = 0.1;
const MAX_DIP_ERROR_RAD: f32 = 10.0_f32.to_radians();
const REFERENCE_S: f32 = 20.0;
const MIN_UNDISTURBED_S: f32 = 0.5;
/// A new steady field is believed after this time in motion; the first one sooner.
const ADOPT_S: f32 = 60.0;
const ADOPT_FIRST_S: f32 = 5.0;
const MIN_MOTION_RPS: f32 = 20.0_f32.to_radians();

/// Strength and dip of a field.
#[derive(Clone, Copy, Debug, Default)]
struct Field {
    norm_ut: f32,
    dip_rad: f32,
}

impl Field {
    fn resembles(self, reference: Self) -> bool {
        (self.norm_ut - reference.norm_ut).abs() < MAX_NORM_ERROR * reference.norm_ut
            && (self.dip_rad - reference.dip_rad).abs() < MAX_DIP_ERROR_RAD
    }

    fn approach(&mut self, other: Self, share: f32) {
        self.norm_ut += share * (other.norm_ut - self.norm_ut);
        self.dip_rad += share * (other.dip_rad - self.dip_rad);
    }
}

#[derive(Clone, Debug)]
pub(super) struct FieldMonitor {
    reference: Option<Field>,
    candidate: Field,
    candidate_s: f32,
    undisturbed_s: f32,
    disturbed: bool,
}

impl FieldMonitor {
    pub const fn new() -> Self {
        Self {
            reference: None,
            candidate: Field {
                norm_ut: 0.0,
                dip_rad: 0.0,
            },
            candidate_s: 0.0,
            undisturbed_s: 0.0,
            disturbed: false,
        }
    }

    /// `norm_ut` of the sample, its vertical part `up_ut`, and how fast the robot turns. True while the field is not
    /// that of the earth as known so far.
    pub fn disturbed(&mut self, norm_ut: f32, up_ut: f32, rate_rps: f32, window_s: f32) -> bool {
        let dip_rad = -scalar::asin(up_ut / norm_ut);
        let field = Field { norm_ut, dip_rad };
        self.compare_with_reference(field, window_s);
        self.follow_candidate(field, rate_rps, window_s);
        self.disturbed
    }

    fn compare_with_reference(&mut self, field: Field, window_s: f32) {
        let share = window_s / REFERENCE_S;
        match &mut self.reference {
            Some(reference) if field.resembles(*reference) => {
                self.undisturbed_s += window_s;
                if self.undisturbed_s >= MIN_UNDISTURBED_S {
                    self.disturbed = false;
                    reference.approach(field, share);
                }
            }
            Some(_) => {
                self.undisturbed_s = 0.0;
                self.disturbed = true;
            }
            None => {}
        }
    }

    fn follow_candidate(&mut self, field: Field, rate_rps: f32, window_s: f32) {
        if !field.resembles(self.candidate) {
            self.candidate_s = 0.0;
            self.candidate = field;
            return;
        }
        if rate_rps >= MIN_MOTION_RPS {
            self.candidate_s += window_s;
        }
        self.candidate.approach(field, window_s / REFERENCE_S);
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
