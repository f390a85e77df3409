//! The setpoints of DM4310 and RS00 in position and speed mode: two floats, little-endian.

use super::mit::MitRanges;
use crate::math::scalar;

/// The payload of position mode. The angle is clamped to the motor's range and the speed limit to 0…`v_max_rps`. If
/// the angle is NaN, the speed limit becomes 0.
pub(super) fn position_speed(pos_rad: f32, max_speed_rps: f32, ranges: &MitRanges) -> [u8; 8] {
    let speed_rps = if pos_rad.is_nan() { 0.0 } else { max_speed_rps };
    two_floats(
        finite_within(pos_rad, ranges.p_max_rad),
        finite_within(speed_rps, ranges.v_max_rps).max(0.0),
    )
}

pub(super) fn two_floats(first: f32, second: f32) -> [u8; 8] {
    let [a, b, c, d] = first.to_le_bytes();
    let [e, f, g, h] = second.to_le_bytes();
    [a, b, c, d, e, f, g, h]
}

/// Clamps to ±`limit`; NaN becomes 0.
pub(super) fn finite_within(value: f32, limit: f32) -> f32 {
    if value.is_nan() {
        return 0.0;
    }
    scalar::clamp(value, -limit, limit)
}
