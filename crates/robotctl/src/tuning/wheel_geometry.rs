//! The wheel geometry as the frames 0x10 and 0x11 carry it: whole millimetres and hundredths.

const LEFT_REVERSED: u8 = 1 << 0;
const RIGHT_REVERSED: u8 = 1 << 1;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelGeometry {
    pub radius_mm: u16,
    /// Distance between the centres of the wheels.
    pub track_mm: u16,
    /// Motor turns for each turn of the wheel, times 100.
    pub gear_ratio_x100: u16,
    /// The motor's positive direction drives backwards.
    pub left_reversed: bool,
    pub right_reversed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a gear ratio of {0} cannot be sent: it must lie in 0.01 … 655.35")]
pub struct GeometryError(f64);

impl WheelGeometry {
    /// Gear ratio in hundredths, as it is sent.
    pub fn hundredths(gear_ratio: f64) -> Result<u16, GeometryError> {
        let hundredths = (gear_ratio * 100.0).round();
        if (1.0..=f64::from(u16::MAX)).contains(&hundredths) {
            Ok(hundredths as u16)
        } else {
            Err(GeometryError(gear_ratio))
        }
    }

    pub(super) fn from_bytes(bytes: [u8; 7]) -> Self {
        let [a, b, c, d, e, f, signs] = bytes;
        Self {
            radius_mm: u16::from_le_bytes([a, b]),
            track_mm: u16::from_le_bytes([c, d]),
            gear_ratio_x100: u16::from_le_bytes([e, f]),
            left_reversed: signs & LEFT_REVERSED != 0,
            right_reversed: signs & RIGHT_REVERSED != 0,
        }
    }

    pub(super) fn to_bytes(self) -> [u8; 7] {
        let [a, b] = self.radius_mm.to_le_bytes();
        let [c, d] = self.track_mm.to_le_bytes();
        let [e, f] = self.gear_ratio_x100.to_le_bytes();
        let left = if self.left_reversed { LEFT_REVERSED } else { 0 };
        let right = if self.right_reversed {
            RIGHT_REVERSED
        } else {
            0
        };
        [a, b, c, d, e, f, left | right]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // ROBOT_CPP's example (docs/port.md#parameters-and-tuning): 19.2 is 1920 = 0x0780; 76 mm = 0x4C, 300 mm = 0x012C.
    #[test]
    fn bytes_are_little_endian_with_signs_last() {
        let geometry = WheelGeometry {
            radius_mm: 76,
            track_mm: 300,
            gear_ratio_x100: WheelGeometry::hundredths(19.2).unwrap(),
            left_reversed: false,
            right_reversed: true,
        };
        let bytes = [0x4C, 0x00, 0x2C, 0x01, 0x80, 0x07, 0x02];
        assert_eq!(geometry.to_bytes(), bytes);
        assert_eq!(WheelGeometry::from_bytes(bytes), geometry);
    }

    #[test]
    fn a_ratio_that_does_not_fit_is_refused() {
        assert!(WheelGeometry::hundredths(0.0).is_err());
        assert!(WheelGeometry::hundredths(700.0).is_err());
        assert!(WheelGeometry::hundredths(f64::NAN).is_err());
    }
}
