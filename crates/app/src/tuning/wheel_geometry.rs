//! The wheel geometry frames of ROBOT_CPP (docs/port.md#parameters-and-tuning), identical to the byte for its
//! clients.

use super::{Refusal, parameters};
use crate::domain::{RobotConfig, WheelOdomConfig};

/// Bits of byte 7.
const LEFT_REVERSED: u8 = 1 << 0;
const RIGHT_REVERSED: u8 = 1 << 1;

/// The seven bytes after the command: radius and track in mm and a hundred times the gear ratio as little-endian
/// `u16`, followed by the signs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelGeometry(pub [u8; 7]);

impl WheelGeometry {
    /// Encodes the geometry, rounded to whole mm and hundredths.
    pub fn of(odom: &WheelOdomConfig) -> Self {
        let [radius_l, radius_h] = rounded(odom.wheel_radius_m * 1_000.0);
        let [track_l, track_h] = rounded(odom.wheel_track_m * 1_000.0);
        let [ratio_l, ratio_h] = rounded(odom.gear_ratio * 100.0);
        let reversed = |sign: f32, bit| if sign < 0.0 { bit } else { 0 };
        let signs = reversed(odom.rpm_sign_left, LEFT_REVERSED)
            | reversed(odom.rpm_sign_right, RIGHT_REVERSED);
        Self([
            radius_l, radius_h, track_l, track_h, ratio_l, ratio_h, signs,
        ])
    }

    /// Applies all five settings. On an error some may have been applied, so use it on a copy of the configuration.
    pub fn apply(self, config: &mut RobotConfig) -> Result<(), Refusal> {
        let Self(
            [
                radius_l,
                radius_h,
                track_l,
                track_h,
                ratio_l,
                ratio_h,
                signs,
            ],
        ) = self;
        if signs & !(LEFT_REVERSED | RIGHT_REVERSED) != 0 {
            return Err(Refusal::OutOfRange);
        }
        let count = |low, high| f32::from(u16::from_le_bytes([low, high]));
        let sign = |bit| if signs & bit != 0 { -1.0 } else { 1.0 };
        let values = [
            count(radius_l, radius_h) / 1_000.0,
            count(track_l, track_h) / 1_000.0,
            count(ratio_l, ratio_h) / 100.0,
            sign(LEFT_REVERSED),
            sign(RIGHT_REVERSED),
        ];
        for (index, value) in (0..).zip(values) {
            parameters::find(parameters::WHEEL_GEOMETRY, index)?.write(config, value)?;
        }
        Ok(())
    }
}

/// The conversion saturates.
fn rounded(value: f32) -> [u8; 2] {
    ((value + 0.5) as u16).to_le_bytes()
}
