//! Finds the hard and soft iron of the robot from samples of the robot turned through all attitudes.
//!
//! The earth's field has the same strength in every attitude, so undisturbed samples lie on a sphere. Magnets shift the
//! sphere (hard iron), and steel stretches it to an ellipsoid (soft iron). The correction makes it a sphere again.

mod coverage;
mod ellipsoid;
mod fit;

#[cfg(test)]
mod tests;

use nalgebra::{Matrix3, Vector3};

pub use coverage::Coverage;

use crate::{recording::Sample, statistics::rms};

/// Largest residual as a share of the field. The magnetometer has 0.3 µT a count and 0.8 µT of noise, some of which
/// always remains.
const MAX_RESIDUAL_SHARE: f64 = 0.05;
/// Least share of the directions from which the field must have come, seen from the robot.
const MIN_COVERED: f64 = 0.75;
/// Largest share of samples left out. A few disturbances are normal, but a disturbed place is not.
const MAX_REJECTED_SHARE: f64 = 0.1;
/// Largest ratio of the ellipsoid's longest to its shortest axis. Beyond it the sensor is next to iron and no
/// correction helps.
const MAX_STRETCH: f64 = 2.0;
/// Range of the field's strength. The earth's field is 22 to 67 µT, and iron changes it.
const PLAUSIBLE_UT: std::ops::Range<f64> = 15.0..120.0;
const MIN_SAMPLES: usize = 200;

/// A correction in the body frame: corrected = soft_iron · (raw − bias), where `soft_iron` is symmetric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MagCorrection {
    pub bias_ut: Vector3<f64>,
    pub soft_iron: Matrix3<f64>,
}

impl MagCorrection {
    pub fn none() -> Self {
        Self {
            bias_ut: Vector3::zeros(),
            soft_iron: Matrix3::identity(),
        }
    }

    pub fn apply(&self, raw_ut: Vector3<f64>) -> Vector3<f64> {
        self.soft_iron * (raw_ut - self.bias_ut)
    }

    /// Returns what the sensor measured before this correction; `None` if it cannot be undone.
    pub fn undo(&self, corrected_ut: Vector3<f64>) -> Option<Vector3<f64>> {
        Some(self.soft_iron.try_inverse()? * corrected_ut + self.bias_ut)
    }
}

/// A correction and the evidence for it.
#[derive(Clone, Debug)]
pub struct MagFit {
    pub correction: MagCorrection,
    /// Strength of the corrected field.
    pub field_ut: f64,
    /// The raw samples from which it was computed.
    pub samples: Vec<Vector3<f64>>,
    pub rejected: usize,
    pub coverage: Coverage,
    /// Standard deviation of the field's strength before the correction.
    pub residual_before_ut: f64,
    pub residual_after_ut: f64,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MagError {
    #[error(
        "{0} different samples are too few ({MIN_SAMPLES} needed): record half a minute of turning"
    )]
    TooFewSamples(usize),
    #[error(
        "too little rotation: the samples do not lie around an ellipsoid; turn the robot about all three axes, upside \
         down too"
    )]
    TooLittleRotation,
    #[error(
        "too little rotation: only {:.0} % of all directions were seen ({:.0} % needed); the field never came from the \
         robot's {missing}",
        covered * 100.0, MIN_COVERED * 100.0
    )]
    Uncovered { covered: f64, missing: String },
    #[error(
        "{rejected} of {all} samples fit no ellipsoid: is there iron, a motor or a cable near the robot that does not turn \
         with it?"
    )]
    Disturbed { rejected: usize, all: usize },
    #[error(
        "after the correction the field's strength still varies by {residual_ut:.2} µT of {field_ut:.1} (limit {:.0} %): \
         go away from iron and running motors and record again",
        MAX_RESIDUAL_SHARE * 100.0
    )]
    BadFit { residual_ut: f64, field_ut: f64 },
    #[error(
        "a field of {field_ut:.1} µT stretched {stretch:.2} times is no earth's field: are the samples µT?"
    )]
    Implausible { field_ut: f64, stretch: f64 },
}

/// Finds the correction from raw samples. The corrected strength is `field_ut`; without it, the samples' mean strength
/// stays.
pub fn calibrate(recordings: &[Vec<Sample>], field_ut: Option<f64>) -> Result<MagFit, MagError> {
    let mut samples: Vec<Vector3<f64>> = recordings.iter().flatten().map(|s| s.value).collect();
    samples.dedup();
    if samples.len() < MIN_SAMPLES {
        return Err(MagError::TooFewSamples(samples.len()));
    }
    let all = samples.len();
    let fit = fit::robust(samples).ok_or(MagError::TooLittleRotation)?;
    let rejected = all - fit.kept.len();
    if rejected as f64 > MAX_REJECTED_SHARE * all as f64 {
        return Err(MagError::Disturbed { rejected, all });
    }
    let (correction, field_ut) = fit.with_strength(field_ut);
    let corrected: Vec<_> = fit.kept.iter().map(|raw| correction.apply(*raw)).collect();
    let coverage = Coverage::of(&corrected);
    check(&coverage, &correction, field_ut)?;
    let fit = MagFit {
        residual_before_ut: spread(&fit.kept),
        residual_after_ut: rms(corrected.iter().map(|v| v.norm() - field_ut)),
        correction,
        field_ut,
        samples: fit.kept,
        rejected,
        coverage,
    };
    if fit.residual_after_ut > MAX_RESIDUAL_SHARE * field_ut {
        return Err(MagError::BadFit {
            residual_ut: fit.residual_after_ut,
            field_ut,
        });
    }
    Ok(fit)
}

fn check(coverage: &Coverage, correction: &MagCorrection, field_ut: f64) -> Result<(), MagError> {
    if coverage.share < MIN_COVERED {
        return Err(MagError::Uncovered {
            covered: coverage.share,
            missing: coverage.widest_gap_words(),
        });
    }
    let stretches = correction.soft_iron.symmetric_eigenvalues();
    let stretch = stretches.max() / stretches.min();
    if stretch > MAX_STRETCH || !PLAUSIBLE_UT.contains(&field_ut) {
        return Err(MagError::Implausible { field_ut, stretch });
    }
    Ok(())
}

/// Returns the standard deviation of the samples' strength.
fn spread(samples: &[Vector3<f64>]) -> f64 {
    let mean = samples.iter().map(|v| v.norm()).sum::<f64>() / samples.len() as f64;
    rms(samples.iter().map(|v| v.norm() - mean))
}
