//! Finds offset and scale of each accelerometer axis from samples of the robot held still on six sides.
//!
//! At rest an accelerometer measures 1 g upwards in every attitude. So every still position gives one equation,
//! |scale · (raw − bias)| = g, and six positions determine the six unknowns.

mod face;
mod fit;
mod still;

#[cfg(test)]
mod tests;

use nalgebra::Vector3;

pub use face::Face;
pub use still::StillWindow;

use crate::{recording::Sample, statistics::rms};

/// Standard gravity, which the firmware uses too.
pub const GRAVITY_MPS2: f64 = 9.806_65;
/// Largest residual, rms over the positions. Still hands and an undamaged sensor stay below 0.03.
const MAX_RESIDUAL_MPS2: f64 = 0.05;
/// Largest offset. The BMI088's is within ±20 mg (typical). Six times that means a damaged sensor or wrong samples, and
/// is the firmware's limit too.
const MAX_BIAS_MPS2: f64 = 1.2;
/// Largest error of the scale. The BMI088's sensitivity is within ±0.8 % (typical).
const MAX_SCALE_ERROR: f64 = 0.08;
/// Number of unknowns. One position on each side gives as many equations, so only more positions can contradict each
/// other.
const UNKNOWNS: usize = 6;

/// A correction for each axis of the body frame: corrected = (raw − bias) · scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccelCorrection {
    pub bias_mps2: Vector3<f64>,
    pub scale: Vector3<f64>,
}

impl AccelCorrection {
    pub const NONE: Self = Self {
        bias_mps2: Vector3::new(0.0, 0.0, 0.0),
        scale: Vector3::new(1.0, 1.0, 1.0),
    };

    pub fn apply(&self, raw_mps2: Vector3<f64>) -> Vector3<f64> {
        (raw_mps2 - self.bias_mps2).component_mul(&self.scale)
    }

    /// Returns what the sensor measured before this correction.
    pub fn undo(&self, corrected_mps2: Vector3<f64>) -> Vector3<f64> {
        corrected_mps2.component_div(&self.scale) + self.bias_mps2
    }

    /// Returns by how much the size of the corrected measurement differs from gravity.
    fn gravity_error(&self, raw_mps2: Vector3<f64>) -> f64 {
        self.apply(raw_mps2).norm() - GRAVITY_MPS2
    }
}

/// A correction and the evidence for it.
#[derive(Clone, Debug)]
pub struct AccelFit {
    pub correction: AccelCorrection,
    /// The positions from which it was computed.
    pub windows: Vec<StillWindow>,
    /// Still positions that were left out because they contradict the others.
    pub rejected: Vec<StillWindow>,
    pub residual_before_mps2: f64,
    pub residual_after_mps2: f64,
}

impl AccelFit {
    /// True if there are more positions than unknowns. Otherwise the residual is zero whatever was measured.
    pub fn is_checked(&self) -> bool {
        self.windows.len() > UNKNOWNS
    }
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AccelError {
    #[error(
        "the robot was never held still for {} s: put it down on each of its six sides for two seconds",
        still::MIN_WINDOW_S
    )]
    NeverStill,
    #[error("missing: {}; record these too (several files may be given)", face::list(.0))]
    MissingFaces(Vec<Face>),
    #[error("the positions do not determine offset and scale: record six different sides")]
    Undetermined,
    #[error(
        "the positions contradict each other by {residual_mps2:.3} m/s² (limit {MAX_RESIDUAL_MPS2}): was the robot moved \
         while it was recorded, or is the sensor loose?"
    )]
    BadFit { residual_mps2: f64 },
    #[error(
        "offset {bias_mps2:.2} m/s² or scale {scale:.3} of the {axis} axis is beyond what the sensor may have: are the \
         samples m/s² of the body frame?"
    )]
    Implausible {
        axis: char,
        bias_mps2: f64,
        scale: f64,
    },
}

/// Finds the correction from recordings of raw samples, each in the order of its times.
pub fn calibrate(recordings: &[Vec<Sample>]) -> Result<AccelFit, AccelError> {
    let windows: Vec<StillWindow> = recordings.iter().flat_map(|r| still::windows(r)).collect();
    if windows.is_empty() {
        return Err(AccelError::NeverStill);
    }
    let missing = face::missing(&windows);
    if !missing.is_empty() {
        return Err(AccelError::MissingFaces(missing));
    }
    let fit::RobustFit {
        correction,
        kept,
        rejected,
    } = fit::robust(windows).ok_or(AccelError::Undetermined)?;
    check_plausible(&correction)?;
    let residual = |c: &AccelCorrection| rms(kept.iter().map(|w| c.gravity_error(w.mean_mps2)));
    let residual_after_mps2 = residual(&correction);
    if residual_after_mps2 > MAX_RESIDUAL_MPS2 {
        return Err(AccelError::BadFit {
            residual_mps2: residual_after_mps2,
        });
    }
    Ok(AccelFit {
        residual_before_mps2: residual(&AccelCorrection::NONE),
        residual_after_mps2,
        correction,
        windows: kept,
        rejected,
    })
}

fn check_plausible(correction: &AccelCorrection) -> Result<(), AccelError> {
    for (index, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
        let (bias_mps2, scale) = (correction.bias_mps2[index], correction.scale[index]);
        if bias_mps2.abs() > MAX_BIAS_MPS2 || (scale - 1.0).abs() > MAX_SCALE_ERROR {
            return Err(AccelError::Implausible {
                axis,
                bias_mps2,
                scale,
            });
        }
    }
    Ok(())
}
