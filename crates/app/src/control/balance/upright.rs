//! The legs seen from the side: how high they hold the hips.

use super::measured::Measured;
use crate::math::scalar;

/// Larger lean in rad counts as this one.
const MAX_LEAN_RAD: f32 = 0.9;
/// The legs are asked to end so much before their hips' stops, in m.
const ASKED_BEFORE_STOPS_M: f32 = 0.025;

/// Height of the hips on legs that lean.
#[derive(Clone, Copy, Debug)]
pub struct Upright {
    /// Sine and cosine of the lean.
    pub sin: f32,
    pub cos: f32,
    /// How much the hips are too low, in m.
    pub sag_m: f32,
    /// How fast they rise, in m/s.
    pub rise_mps: f32,
}

impl Upright {
    /// Hips that shall be `height_m` above the axles, on legs that reach `longest_m`.
    pub fn new(height_m: f32, longest_m: f32, measured: &Measured) -> Self {
        let lean_rad = scalar::clamp(measured.mean_lean_rad(), -MAX_LEAN_RAD, MAX_LEAN_RAD);
        let (sin, cos) = scalar::sin_cos_small(lean_rad);
        let length_m = measured.length_m();
        let most_m = (longest_m - ASKED_BEFORE_STOPS_M) * cos;
        Self {
            sin,
            cos,
            sag_m: scalar::min(height_m, most_m) - length_m * cos,
            rise_mps: measured.length_mps() * cos - length_m * sin * measured.mean_lean_rps(),
        }
    }
}
