//! The command and reply fields that DM4310 and RS00 share: five numbers as unsigned codes over each motor's ranges
//! (docs/hardware.md#mit-frames, and the C code in RobStride's MIT reference).

use crate::math::scalar;

/// Full scale of a motor's codes, symmetric about zero, in motor coordinates at the output shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MitRanges {
    /// Largest angle in rad.
    pub p_max_rad: f32,
    /// Largest speed in rad/s.
    pub v_max_rps: f32,
    /// Largest torque in N·m.
    pub t_max_nm: f32,
}

/// Setpoints in motor coordinates. They may hold any value, even NaN.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MitTargets {
    /// Target angle in rad.
    pub pos_rad: f32,
    /// Target speed in rad/s.
    pub vel_rps: f32,
    /// Stiffness in N·m/rad.
    pub kp: f32,
    /// Damping in N·m·s/rad.
    pub kd: f32,
    /// Feed-forward torque in N·m.
    pub torque_nm: f32,
}

/// An encodable command: every field is within its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MitCommand {
    position: u16,
    velocity: u16,
    kp: u16,
    kd: u16,
    torque: u16,
}

/// What a motor reports besides temperature and state, in motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MitReport {
    /// The received code of the angle, to detect any change.
    pub position_code: u16,
    /// Angle in rad.
    pub pos_rad: f32,
    /// Speed in rad/s.
    pub vel_rps: f32,
    /// Torque in N·m.
    pub torque_nm: f32,
}

/// Largest stiffness in N·m/rad.
pub const KP_MAX: f32 = 500.0;
/// Largest damping in N·m·s/rad.
pub const KD_MAX: f32 = 5.0;
const LAST_CODE_16: f32 = 65_535.0;
const LAST_CODE_12: f32 = 4_095.0;

impl MitCommand {
    /// Clamps each field to its range; NaN becomes 0. The codes are truncated, as in the reference code, so zero
    /// becomes the code half a step below it.
    pub fn clamped(targets: &MitTargets, ranges: &MitRanges) -> Self {
        let MitRanges {
            p_max_rad,
            v_max_rps,
            t_max_nm,
        } = *ranges;
        Self {
            position: code(targets.pos_rad, -p_max_rad, p_max_rad, LAST_CODE_16),
            velocity: code(targets.vel_rps, -v_max_rps, v_max_rps, LAST_CODE_12),
            kp: code(targets.kp, 0.0, KP_MAX, LAST_CODE_12),
            kd: code(targets.kd, 0.0, KD_MAX, LAST_CODE_12),
            torque: code(targets.torque_nm, -t_max_nm, t_max_nm, LAST_CODE_12),
        }
    }

    /// The eight bytes of the frame.
    pub fn payload(self) -> [u8; 8] {
        let [p_high, p_low] = self.position.to_be_bytes();
        let velocity_kp = u32::from(self.velocity) << 12 | u32::from(self.kp);
        let kd_torque = u32::from(self.kd) << 12 | u32::from(self.torque);
        let [_, vk_high, vk_mid, vk_low] = velocity_kp.to_be_bytes();
        let [_, dt_high, dt_mid, dt_low] = kd_torque.to_be_bytes();
        [
            p_high, p_low, vk_high, vk_mid, vk_low, dt_high, dt_mid, dt_low,
        ]
    }
}

impl MitReport {
    /// Decodes bytes 1 to 5 of a reply.
    pub fn decode([p_high, p_low, v_high, v_t, t_low]: [u8; 5], ranges: &MitRanges) -> Self {
        let position_code = u16::from_be_bytes([p_high, p_low]);
        let velocity = u16::from(v_high) << 4 | u16::from(v_t >> 4);
        let torque = u16::from(v_t & 0x0F) << 8 | u16::from(t_low);
        Self {
            position_code,
            pos_rad: value(position_code, ranges.p_max_rad, LAST_CODE_16),
            vel_rps: value(velocity, ranges.v_max_rps, LAST_CODE_12),
            torque_nm: value(torque, ranges.t_max_nm, LAST_CODE_12),
        }
    }
}

/// `float_to_uint` of the reference code.
fn code(value: f32, min: f32, max: f32, last_code: f32) -> u16 {
    let number = if value.is_nan() { 0.0 } else { value };
    let inside = scalar::clamp(number, min, max);
    // Never above `last_code`. The core converts to 32 bits in one instruction, to 16 in many.
    ((inside - min) * last_code / (max - min)) as u32 as u16
}

/// `uint_to_float` of the reference code.
fn value(code: u16, max: f32, last_code: f32) -> f32 {
    f32::from(code) * (2.0 * max) / last_code - max
}

#[cfg(test)]
mod tests {
    use super::*;

    const DM: MitRanges = MitRanges {
        p_max_rad: 12.5,
        v_max_rps: 30.0,
        t_max_nm: 10.0,
    };

    /// A vector of docs/hardware.md#test-vectors.
    #[test]
    fn zero_becomes_the_code_just_below_zero() {
        let zero = MitCommand::clamped(&MitTargets::default(), &DM);
        assert_eq!(
            zero.payload(),
            [0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF]
        );
    }

    #[test]
    fn nan_becomes_zero() {
        let nan = MitTargets {
            pos_rad: f32::NAN,
            vel_rps: f32::NAN,
            kp: f32::NAN,
            kd: f32::NAN,
            torque_nm: f32::NAN,
        };
        assert_eq!(
            MitCommand::clamped(&nan, &DM),
            MitCommand::clamped(&MitTargets::default(), &DM)
        );
    }

    #[test]
    fn infinity_is_clamped_to_the_range() {
        let up = MitTargets {
            pos_rad: f32::INFINITY,
            vel_rps: f32::INFINITY,
            kp: f32::INFINITY,
            kd: f32::INFINITY,
            torque_nm: f32::INFINITY,
        };
        let down = MitTargets {
            pos_rad: f32::NEG_INFINITY,
            vel_rps: f32::NEG_INFINITY,
            kp: f32::NEG_INFINITY,
            kd: f32::NEG_INFINITY,
            torque_nm: f32::NEG_INFINITY,
        };
        assert_eq!(MitCommand::clamped(&up, &DM).payload(), [0xFF; 8]);
        assert_eq!(MitCommand::clamped(&down, &DM).payload(), [0; 8]);
    }
}
