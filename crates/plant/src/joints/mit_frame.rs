//! The packing that Damiao and RobStride share (docs/hardware.md#mit-frames): fields of 16 and 12 bits,
//! most significant first, each spread evenly over its range.

/// Ranges of the coding, each symmetric about zero. The motor itself has other limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ranges {
    pub pos_rad: f64,
    pub vel_rps: f64,
    pub torque_nm: f64,
}

const MAX_KP: f64 = 500.0;
const MAX_KD: f64 = 5.0;

/// The command in a motion-control frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MitCommand {
    pub pos_rad: f64,
    pub vel_rps: f64,
    pub kp_nm_per_rad: f64,
    pub kd_nms_per_rad: f64,
    pub torque_nm: f64,
}

impl MitCommand {
    pub(super) fn commanded_nm(&self, pos_rad: f64, vel_rps: f64) -> f64 {
        self.kp_nm_per_rad * (self.pos_rad - pos_rad)
            + self.kd_nms_per_rad * (self.vel_rps - vel_rps)
            + self.torque_nm
    }
}

/// Position and speed that the receiver of a reply decodes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Feedback {
    pub pos_rad: f64,
    pub vel_rps: f64,
}

impl Ranges {
    pub(super) fn command(&self, data: &[u8; 8]) -> MitCommand {
        let bits = u64::from_be_bytes(*data);
        let field = |low: u32, width: u32| (bits >> low) as u32 & ((1 << width) - 1);
        MitCommand {
            pos_rad: value(field(48, 16), 16, -self.pos_rad, self.pos_rad),
            vel_rps: value(field(36, 12), 12, -self.vel_rps, self.vel_rps),
            kp_nm_per_rad: value(field(24, 12), 12, 0.0, MAX_KP),
            kd_nms_per_rad: value(field(12, 12), 12, 0.0, MAX_KD),
            torque_nm: value(field(0, 12), 12, -self.torque_nm, self.torque_nm),
        }
    }

    /// The five bytes of position, speed and torque in a reply, and what a receiver decodes from them.
    pub(super) fn feedback(
        &self,
        pos_rad: f64,
        vel_rps: f64,
        torque_nm: f64,
    ) -> ([u8; 5], Feedback) {
        let pos = code(pos_rad, 16, self.pos_rad);
        let vel = code(vel_rps, 12, self.vel_rps);
        let torque = code(torque_nm, 12, self.torque_nm);
        let bits = u64::from(pos) << 24 | u64::from(vel) << 12 | u64::from(torque);
        let [_, _, _, bytes @ ..] = bits.to_be_bytes();
        let decoded = Feedback {
            pos_rad: value(pos, 16, -self.pos_rad, self.pos_rad),
            vel_rps: value(vel, 12, -self.vel_rps, self.vel_rps),
        };
        (bytes, decoded)
    }
}

/// Clips and truncates, as the reference code of both makers does.
fn code(value: f64, bits: u32, most: f64) -> u32 {
    let steps = f64::from((1_u32 << bits) - 1);
    ((value.clamp(-most, most) + most) * steps / (2.0 * most)) as u32
}

fn value(code: u32, bits: u32, least: f64, most: f64) -> f64 {
    f64::from(code) * (most - least) / f64::from((1_u32 << bits) - 1) + least
}

#[cfg(test)]
mod tests {
    use super::*;

    const DM4310: Ranges = Ranges {
        pos_rad: 12.5,
        vel_rps: 30.0,
        torque_nm: 10.0,
    };
    const RS00: Ranges = Ranges {
        pos_rad: 12.57,
        vel_rps: 33.0,
        torque_nm: 14.0,
    };

    fn close(command: MitCommand, expected: [f64; 5]) {
        let MitCommand {
            pos_rad,
            vel_rps,
            kp_nm_per_rad,
            kd_nms_per_rad,
            torque_nm,
        } = command;
        let got = [pos_rad, vel_rps, kp_nm_per_rad, kd_nms_per_rad, torque_nm];
        // One step of each field: 25/65535, 60/4095 (66/4095), 500/4095, 5/4095, 20/4095 (28/4095).
        let step = [4e-4, 0.0162, 0.1222, 1.23e-3, 6.9e-3];
        for ((got, expected), step) in got.iter().zip(expected).zip(step) {
            assert!((got - expected).abs() <= step, "{command:?}");
        }
    }

    // A vector of docs/hardware.md#test-vectors.
    #[test]
    fn reference_commands_decode() {
        let one = [0x8A, 0x3C, 0x7F, 0xF0, 0xA3, 0x33, 0x38, 0x65];
        close(DM4310.command(&one), [1.0, 0.0, 20.0, 1.0, 0.5]);
        let same = [0x8A, 0x2E, 0x7F, 0xF0, 0xA3, 0x33, 0x38, 0x48];
        close(RS00.command(&same), [1.0, 0.0, 20.0, 1.0, 0.5]);
    }

    // docs/hardware.md#test-vectors: p −1.9e-4, v −7.3e-3, t −2.4e-3.
    #[test]
    fn the_code_of_zero_is_slightly_below_zero() {
        let zero = DM4310.command(&[0x7F, 0xFF, 0x7F, 0xF0, 0, 0, 0x07, 0xFF]);
        assert!((zero.pos_rad + 1.907e-4).abs() < 1e-7);
        assert!((zero.vel_rps + 7.326e-3).abs() < 1e-6);
        assert!((zero.torque_nm + 2.442e-3).abs() < 1e-6);
        assert_eq!((zero.kp_nm_per_rad, zero.kd_nms_per_rad), (0.0, 0.0));
    }

    /// 1 rad of ±12.5: (13.5/25)·65535 = 35388.9 → 0x8A3C. −10 of ±30: (20/60)·4095 = 1365 → 0x555. Torque beyond the
    /// range: 0xFFF.
    #[test]
    fn feedback_truncates_and_clips() {
        let (bytes, decoded) = DM4310.feedback(1.0, -10.0, 11.0);
        assert_eq!(bytes, [0x8A, 0x3C, 0x55, 0x5F, 0xFF]);
        assert!((decoded.pos_rad - 1.0).abs() < 4e-4 && (decoded.vel_rps + 10.0).abs() < 1e-9);
    }
}
