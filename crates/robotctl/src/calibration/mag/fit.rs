//! Fits the correction that makes the field equally strong in every sample.

use nalgebra::{Matrix3, SVector, Vector3};

use super::{MagCorrection, ellipsoid::Ellipsoid};
use crate::{calibration::least_squares, statistics::median};

/// A sample this many times further from the centre than usual is a glitch, which would spoil the start of the fit.
const FAR_FACTOR: f64 = 3.0;
/// A sample is left out if the relative error of its strength exceeds this and five times the usual error.
const OUTLIER: f64 = 0.08;
const OUTLIER_FACTOR: f64 = 5.0;
/// Largest number of rounds of fitting and leaving out.
const ROUNDS: usize = 10;

/// A fit after which the field of the `kept` samples has the strength 1.
pub(super) struct UnitFit {
    correction: MagCorrection,
    pub kept: Vec<Vector3<f64>>,
}

/// Fits the samples that do not contradict the others. It returns `None` if they do not determine the correction.
pub(super) fn robust(mut kept: Vec<Vector3<f64>>) -> Option<UnitFit> {
    drop_far(&mut kept);
    let start = Ellipsoid::through(&kept)?;
    let mut correction = MagCorrection {
        bias_ut: start.centre,
        soft_iron: start.shape,
    };
    for _ in 0..ROUNDS {
        correction = refine(&correction, &kept)?;
        let before = kept.len();
        drop_outliers(&correction, &mut kept);
        if kept.len() == before {
            break;
        }
    }
    Some(UnitFit { correction, kept })
}

impl UnitFit {
    /// Returns the correction that makes the field `strength_ut` strong. Without a strength, the correction has the
    /// determinant 1, so that it stretches as much as it shrinks and the mean strength stays.
    pub fn with_strength(&self, strength_ut: Option<f64>) -> (MagCorrection, f64) {
        let natural = 1.0 / self.correction.soft_iron.determinant().cbrt();
        let strength_ut = strength_ut.unwrap_or(natural);
        let correction = MagCorrection {
            bias_ut: self.correction.bias_ut,
            soft_iron: self.correction.soft_iron * strength_ut,
        };
        (correction, strength_ut)
    }
}

fn drop_far(samples: &mut Vec<Vector3<f64>>) {
    let axis_median = |axis: usize| median(samples.iter().map(|v| v[axis]).collect());
    let middle = Vector3::from_fn(|axis, _| axis_median(axis));
    let usual = median(samples.iter().map(|v| (v - middle).norm()).collect());
    samples.retain(|v| (v - middle).norm() <= FAR_FACTOR * usual);
}

fn drop_outliers(correction: &MagCorrection, samples: &mut Vec<Vector3<f64>>) {
    let error = |raw: &Vector3<f64>| (correction.apply(*raw).norm() - 1.0).abs();
    let usual = median(samples.iter().map(error).collect());
    samples.retain(|raw| error(raw) <= OUTLIER.max(OUTLIER_FACTOR * usual));
}

/// Minimises the error of the strength. The linear fit minimises an algebraic error, which noise biases.
fn refine(start: &MagCorrection, samples: &[Vector3<f64>]) -> Option<MagCorrection> {
    let found = least_squares::minimise(parameters(start), |p| {
        let correction = correction(p);
        samples.iter().map(move |raw| equation(&correction, *raw))
    })?;
    Some(correction(&found))
}

/// Returns the residual |soft_iron · (raw − bias)| − 1 and its derivatives.
fn equation(correction: &MagCorrection, raw_ut: Vector3<f64>) -> (f64, SVector<f64, 9>) {
    let offset = raw_ut - correction.bias_ut;
    let corrected = correction.soft_iron * offset;
    let size = corrected.norm();
    let direction = corrected / size;
    let by_bias = -(correction.soft_iron * direction);
    let derivatives = SVector::from([
        by_bias.x,
        by_bias.y,
        by_bias.z,
        direction.x * offset.x,
        direction.y * offset.y,
        direction.z * offset.z,
        direction.x * offset.y + direction.y * offset.x,
        direction.x * offset.z + direction.z * offset.x,
        direction.y * offset.z + direction.z * offset.y,
    ]);
    (size - 1.0, derivatives)
}

fn parameters(c: &MagCorrection) -> SVector<f64, 9> {
    let (b, s) = (c.bias_ut, c.soft_iron);
    SVector::from([
        b.x,
        b.y,
        b.z,
        s[(0, 0)],
        s[(1, 1)],
        s[(2, 2)],
        s[(0, 1)],
        s[(0, 2)],
        s[(1, 2)],
    ])
}

fn correction(parameters: &SVector<f64, 9>) -> MagCorrection {
    let [bx, by, bz, xx, yy, zz, xy, xz, yz] = parameters.data.0[0];
    MagCorrection {
        bias_ut: Vector3::new(bx, by, bz),
        soft_iron: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
    }
}
