//! The correction that makes the field equally strong in every sample.

use nalgebra::{Matrix3, SVector, Vector3};

use super::{MagCorrection, ellipsoid::Ellipsoid};
use crate::{calibration::least_squares, statistics::median};

/// Further from the middle of all samples than this many times the usual distance: a glitch that would pull the start.
const FAR_FACTOR: f64 = 3.0;
/// Relative error of the strength beyond this, and beyond five times what is usual here, leaves a sample out.
const OUTLIER: f64 = 0.08;
const OUTLIER_FACTOR: f64 = 5.0;
/// Rounds of fitting and leaving out.
const ROUNDS: usize = 10;

/// `correction` makes the field of the `kept` samples 1 strong.
pub(super) struct UnitFit {
    correction: MagCorrection,
    pub kept: Vec<Vector3<f64>>,
}

/// `None` if the samples do not determine the correction.
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
    /// With the field `strength_ut` strong; without one, the samples' mean strength stays: the correction then stretches
    /// as much as it shrinks (determinant 1).
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

/// The linear fit minimises a quantity without meaning and is bent by noise; this one minimises the strength's error.
fn refine(start: &MagCorrection, samples: &[Vector3<f64>]) -> Option<MagCorrection> {
    let found = least_squares::minimise(parameters(start), |p| {
        let correction = correction(p);
        samples.iter().map(move |raw| equation(&correction, *raw))
    })?;
    Some(correction(&found))
}

/// Residual |soft_iron · (raw − bias)| − 1 and its derivatives.
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
