//! What differs between servos and calibration.

use std::fmt;

/// A servo is not set as the calibration says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mismatch {
    Offset {
        joint: String,
        wanted: i32,
        has: i32,
    },
    Mode {
        joint: String,
        has: i32,
    },
    Model {
        joint: String,
        has: i32,
    },
    /// Servos of one arm have several firmwares.
    Firmware {
        versions: String,
    },
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Offset { joint, wanted, has } => write!(
                f,
                "{joint}: the servo's homing_offset is {has}, and this calibration is for {wanted}, so that home and limits \
                 are {} steps off. Was it calibrated by another program, or its offset lost? `armctl calibrate --apply` stores \
                 the file's",
                (has - wanted).abs()
            ),
            Self::Mode { joint, has } => write!(
                f,
                "{joint}: the servo's mode is {has}, and positions need 0: `armctl calibrate --apply` sets it"
            ),
            Self::Model { joint, has } => write!(
                f,
                "{joint}: the servo's model is {has}, and this program knows 777 (STS3215): its registers may differ"
            ),
            Self::Firmware { versions } => write!(
                f,
                "the servos have different firmware ({versions}). They work together here; programs that ask for one \
                 version want them updated with the manufacturer's tool"
            ),
        }
    }
}
