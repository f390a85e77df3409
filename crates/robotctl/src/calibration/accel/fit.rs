//! Fits the correction that makes every still position measure 1 g.

use nalgebra::{SVector, Vector3};

use super::{AccelCorrection, GRAVITY_MPS2, StillWindow, face};
use crate::{calibration::least_squares, statistics::median};

/// A position is left out if its residual exceeds this and four times the usual residual.
const OUTLIER_MPS2: f64 = 0.1;
const OUTLIER_FACTOR: f64 = 4.0;

pub(super) struct RobustFit {
    pub correction: AccelCorrection,
    pub kept: Vec<StillWindow>,
    pub rejected: Vec<StillWindow>,
}

/// Fits the correction. While the worst position contradicts the others and its side was recorded twice, it is left out
/// and the fit is repeated. The result is `None` if the positions do not determine the correction.
pub(super) fn robust(windows: Vec<StillWindow>) -> Option<RobustFit> {
    let mut kept = windows;
    let mut rejected = Vec::new();
    loop {
        let correction = least_squares(&kept)?;
        let Some(worst) = outlier(&correction, &kept) else {
            return Some(RobustFit {
                correction,
                kept,
                rejected,
            });
        };
        rejected.push(kept.remove(worst));
    }
}

fn outlier(correction: &AccelCorrection, windows: &[StillWindow]) -> Option<usize> {
    let errors: Vec<f64> = windows
        .iter()
        .map(|w| correction.gravity_error(w.mean_mps2).abs())
        .collect();
    let limit = OUTLIER_MPS2.max(OUTLIER_FACTOR * median(errors.clone()));
    (0..windows.len())
        .filter(|&index| errors[index] > limit && is_spare(windows, index))
        .max_by(|&a, &b| errors[a].total_cmp(&errors[b]))
}

/// True if all six sides remain without this position.
fn is_spare(windows: &[StillWindow], index: usize) -> bool {
    let mut others = windows.to_vec();
    others.remove(index);
    face::missing(&others).is_empty()
}

fn least_squares(windows: &[StillWindow]) -> Option<AccelCorrection> {
    let found = least_squares::minimise(parameters(&AccelCorrection::NONE), |p| {
        let correction = correction(p);
        windows
            .iter()
            .map(move |window| equation(&correction, window.mean_mps2))
    })?;
    Some(correction(&found))
}

/// Returns the residual |scale · (raw − bias)| − g and its derivatives.
fn equation(correction: &AccelCorrection, raw_mps2: Vector3<f64>) -> (f64, SVector<f64, 6>) {
    let corrected = correction.apply(raw_mps2);
    let size = corrected.norm();
    let direction = corrected / size;
    let by_bias = -direction.component_mul(&correction.scale);
    let by_scale = direction.component_mul(&(raw_mps2 - correction.bias_mps2));
    let derivatives = SVector::<f64, 6>::from_iterator(by_bias.iter().chain(&by_scale).copied());
    (size - GRAVITY_MPS2, derivatives)
}

fn parameters(correction: &AccelCorrection) -> SVector<f64, 6> {
    let all = correction.bias_mps2.iter().chain(&correction.scale);
    SVector::from_iterator(all.copied())
}

fn correction(parameters: &SVector<f64, 6>) -> AccelCorrection {
    AccelCorrection {
        bias_mps2: parameters.fixed_rows::<3>(0).into(),
        scale: parameters.fixed_rows::<3>(3).into(),
    }
}
