//! Floats as integers spread evenly over a range, as in sections 5 and 6 of the link's document.

use crate::math::scalar;
use core::f32::consts::PI;

/// A range of floats. The lowest code stands for `min`, the highest for `max`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    min: f32,
    max: f32,
}

/// Angle of a motor in rad.
pub(super) const ANGLE: Scale = Scale::new(-PI, PI);
/// Speed of a motor in rad/s, in state frames.
pub(super) const SPEED: Scale = Scale::new(-33.0, 33.0);
/// Speed target of a wheel in rad/s.
pub(super) const WHEEL_TARGET: Scale = Scale::new(-200.0, 200.0);
/// Position target of a joint in rad.
pub(super) const JOINT_TARGET: Scale = Scale::new(-3.2, 3.2);
/// Kp and Kd.
pub(super) const GAIN: Scale = Scale::new(0.0, 1000.0);
/// A share of the highest speed, of the travel and the like.
pub(super) const SHARE: Scale = Scale::new(-1.0, 1.0);
/// Battery voltage.
pub(super) const VOLTAGE: Scale = Scale::new(20.0, 60.0);

impl Scale {
    const fn new(min: f32, max: f32) -> Self {
        Self { min, max }
    }

    /// The nearest code. Values beyond the range get the code of its end, NaN that of the value nearest to 0.
    pub(super) fn code16(self, value: f32) -> [u8; 2] {
        ((self.fraction(value) * 65_535.0 + 0.5) as u16).to_le_bytes()
    }

    /// The same with 8 bits.
    pub(super) fn code8(self, value: f32) -> u8 {
        (self.fraction(value) * 255.0 + 0.5) as u8
    }

    /// The value of a code with 16 bits.
    pub(super) fn value16(self, code: [u8; 2]) -> f32 {
        self.value(f32::from(u16::from_le_bytes(code)) / 65_535.0)
    }

    /// The value of a code with 8 bits.
    pub(super) fn value8(self, code: u8) -> f32 {
        self.value(f32::from(code) / 255.0)
    }

    fn fraction(self, value: f32) -> f32 {
        let number = if value.is_nan() { 0.0 } else { value };
        (scalar::clamp(number, self.min, self.max) - self.min) / (self.max - self.min)
    }

    fn value(self, fraction: f32) -> f32 {
        fraction * (self.max - self.min) + self.min
    }
}

/// A float that is sent as it is. NaN becomes 0, and infinity the largest float.
pub(super) fn finite(value: f32) -> [u8; 4] {
    let number = if value.is_nan() { 0.0 } else { value };
    scalar::clamp(number, f32::MIN, f32::MAX).to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Scale; 7] = [
        ANGLE,
        SPEED,
        WHEEL_TARGET,
        JOINT_TARGET,
        GAIN,
        SHARE,
        VOLTAGE,
    ];

    #[test]
    fn every_code_survives_the_way_there_and_back() {
        for scale in ALL {
            for code in 0..=u16::MAX {
                let code = code.to_le_bytes();
                assert_eq!(scale.code16(scale.value16(code)), code, "{scale:?}");
            }
            for code in 0..=u8::MAX {
                assert_eq!(scale.code8(scale.value8(code)), code, "{scale:?}");
            }
        }
    }

    /// A value a quarter of a step from a code gets that code.
    #[test]
    fn codes_are_rounded_to_the_nearest() {
        for scale in ALL {
            let step = (f64::from(scale.max) - f64::from(scale.min)) / 65_535.0;
            for code in 1..u16::MAX {
                for quarter in [-0.25, 0.25] {
                    let value = f64::from(scale.min) + (f64::from(code) + quarter) * step;
                    assert_eq!(scale.code16(value as f32), code.to_le_bytes(), "{scale:?}");
                }
            }
        }
    }

    #[test]
    fn values_beyond_the_range_and_nan_have_codes() {
        for scale in ALL {
            assert_eq!(scale.code16(f32::INFINITY), [255; 2]);
            assert_eq!(scale.code16(f32::NEG_INFINITY), [0; 2]);
            assert_eq!(scale.code16(f32::NAN), scale.code16(0.0));
            assert_eq!(scale.code8(f32::MAX), 255);
            assert_eq!(scale.code8(f32::MIN), 0);
        }
        assert_eq!(SPEED.code16(f32::NAN), 0x8000_u16.to_le_bytes());
        assert_eq!(VOLTAGE.code8(f32::NAN), 0);
    }

    #[test]
    fn floats_are_sent_finite() {
        assert_eq!(finite(f32::NAN), 0.0_f32.to_le_bytes());
        assert_eq!(finite(f32::INFINITY), f32::MAX.to_le_bytes());
        assert_eq!(finite(f32::NEG_INFINITY), f32::MIN.to_le_bytes());
        assert_eq!(finite(-1.5), (-1.5_f32).to_le_bytes());
    }
}
