//! One joint: how it moves, how far, and how its servo is geared to it.

use super::KinematicsError;

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// It turns; its value is an angle in rad.
    Revolute,
    /// It slides; its value is a length in m.
    Prismatic,
}

/// A joint with its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    name: String,
    lower: f64,
    upper: f64,
    gear: Gear,
}

impl Joint {
    /// A joint that moves between two limits, rad or m. They may be infinite, for a joint that turns without end.
    ///
    /// # Errors
    /// A limit is NaN, or the upper one is below the lower one.
    pub fn new(name: &str, lower: f64, upper: f64) -> Result<Self, KinematicsError> {
        if lower <= upper {
            return Ok(Self::within(name, [lower, upper]));
        }
        Err(KinematicsError::Limits {
            joint: name.to_owned(),
            lower,
            upper,
        })
    }

    /// As [`new`](Self::new), for limits that were looked at.
    pub(super) fn within(name: &str, [lower, upper]: [f64; 2]) -> Self {
        Self {
            name: name.to_owned(),
            lower,
            upper,
            gear: Gear::DIRECT,
        }
    }

    /// Name of the joint, as in the calibration file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Least value, rad or m.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Greatest value, rad or m.
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// What lies between the servo's shaft and the joint.
    pub fn gear(&self) -> Gear {
        self.gear
    }

    pub(super) fn set_gear(&mut self, gear: Gear) {
        self.gear = gear;
    }
}

/// What lies between a servo's shaft and its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    sign: f64,
    ratio: f64,
}

impl Gear {
    /// The joint turns with the shaft.
    pub const DIRECT: Self = Self {
        sign: 1.0,
        ratio: 1.0,
    };

    /// A gear whose shaft turns `sign · ratio` times as far as the joint.
    ///
    /// # Errors
    /// `sign` is neither 1 nor −1, or `ratio` is not positive and finite.
    pub fn new(sign: f64, ratio: f64) -> Result<Self, KinematicsError> {
        if sign.abs() == 1.0 && ratio.is_finite() && ratio > 0.0 {
            return Ok(Self { sign, ratio });
        }
        Err(KinematicsError::Gear { sign, ratio })
    }

    /// 1 if steps grow with the angle, −1 if they shrink.
    pub fn sign(self) -> f64 {
        self.sign
    }

    /// Turns of the shaft for one of the joint.
    pub fn ratio(self) -> f64 {
        self.ratio
    }
}
