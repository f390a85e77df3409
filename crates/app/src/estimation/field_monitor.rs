//! Is this the earth's field? (VQF section 3.6, default thresholds)

use super::low_pass::LowPass;
use crate::math::scalar;

/// Share of the reference strength.
const MAX_NORM_ERROR: f32 = 0.1;
const MAX_DIP_ERROR_RAD: f32 = 10.0_f32.to_radians();
const SMOOTHING_S: f32 = 0.05;
const REFERENCE_S: f32 = 20.0;
const MIN_UNDISTURBED_S: f32 = 0.5;
/// A new steady field is believed after this time in motion; the first one sooner.
const ADOPT_S: f32 = 20.0;
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
    smooth: LowPass<2>,
    sample_s: f32,
    reference: Option<Field>,
    candidate: Field,
    candidate_s: f32,
    undisturbed_s: f32,
    disturbed: bool,
}

impl FieldMonitor {
    pub fn new(sample_s: f32) -> Self {
        Self {
            smooth: LowPass::new(SMOOTHING_S, sample_s),
            sample_s,
            reference: None,
            candidate: Field::default(),
            candidate_s: 0.0,
            undisturbed_s: 0.0,
            disturbed: true,
        }
    }

    /// `norm_ut` of the sample, its vertical part `up_ut`, and how fast the robot turns. True while the field is not
    /// that of the earth as known so far.
    pub fn disturbed(&mut self, norm_ut: f32, up_ut: f32, rate_rps: f32) -> bool {
        let dip_rad = -scalar::asin(up_ut / norm_ut);
        let [norm_ut, dip_rad] = self.smooth.feed([norm_ut, dip_rad]);
        let field = Field { norm_ut, dip_rad };
        self.compare_with_reference(field);
        self.follow_candidate(field, rate_rps);
        self.disturbed
    }

    fn compare_with_reference(&mut self, field: Field) {
        let share = self.sample_s / REFERENCE_S;
        match &mut self.reference {
            Some(reference) if field.resembles(*reference) => {
                self.undisturbed_s += self.sample_s;
                if self.undisturbed_s >= MIN_UNDISTURBED_S {
                    self.disturbed = false;
                    reference.approach(field, share);
                }
            }
            _ => {
                self.undisturbed_s = 0.0;
                self.disturbed = true;
            }
        }
    }

    fn follow_candidate(&mut self, field: Field, rate_rps: f32) {
        if !field.resembles(self.candidate) {
            self.candidate_s = 0.0;
            self.candidate = field;
            return;
        }
        if rate_rps >= MIN_MOTION_RPS {
            self.candidate_s += self.sample_s;
        }
        self.candidate.approach(field, self.sample_s / REFERENCE_S);
        let needed_s = match self.reference {
            Some(_) => ADOPT_S,
            None => ADOPT_FIRST_S,
        };
        if self.disturbed && self.candidate_s >= needed_s {
            self.reference = Some(self.candidate);
            self.disturbed = false;
            self.undisturbed_s = MIN_UNDISTURBED_S;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE_S: f32 = 0.02;

    fn feed(monitor: &mut FieldMonitor, seconds: f32, norm_ut: f32, up_ut: f32) -> bool {
        let mut disturbed = true;
        for _ in 0..(seconds / SAMPLE_S) as u32 {
            disturbed = monitor.disturbed(norm_ut, up_ut, 1.0);
        }
        disturbed
    }

    #[test]
    fn the_first_steady_field_is_adopted_and_a_magnet_is_noticed() {
        let mut monitor = FieldMonitor::new(SAMPLE_S);
        assert!(feed(&mut monitor, 4.0, 50.0, -45.0));
        assert!(!feed(&mut monitor, 2.0, 50.0, -45.0));
        assert!(feed(&mut monitor, 1.0, 70.0, -45.0));
        assert!(!feed(&mut monitor, 2.0, 50.0, -45.0));
    }

    #[test]
    fn a_lasting_new_field_becomes_the_reference() {
        let mut monitor = FieldMonitor::new(SAMPLE_S);
        feed(&mut monitor, 10.0, 50.0, -45.0);
        assert!(feed(&mut monitor, 15.0, 70.0, -45.0));
        assert!(!feed(&mut monitor, 10.0, 70.0, -45.0));
    }
}
