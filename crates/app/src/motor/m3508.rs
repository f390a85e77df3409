//! DJI M3508 with C620 speed controller (docs/hardware.md#c620-and-m3508): standard identifiers, big-endian.

use crate::domain::{CanFrame, MotorCurrent, StandardId, WheelFeedback};

/// Number set on a speed controller, 1…4, which are addressed by the first command group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EscId(u8);

impl EscId {
    /// Returns `None` outside 1…4.
    pub const fn new(number: u8) -> Option<Self> {
        if number >= 1 && number <= 4 {
            Some(Self(number))
        } else {
            None
        }
    }

    /// Identifier of its feedback: 0x201…0x204.
    pub const fn feedback_id(self) -> StandardId {
        match StandardId::new(COMMAND_ID.raw() | self.0 as u16) {
            Some(id) => id,
            None => COMMAND_ID,
        }
    }

    /// Its index in the command frame, 0…3.
    pub const fn index(self) -> usize {
        self.0.saturating_sub(1) as usize
    }
}

/// Identifier of the frame with the currents of controllers 1 to 4.
pub const COMMAND_ID: StandardId = match StandardId::new(0x200) {
    Some(id) => id,
    None => unreachable!(),
};

/// Counts at ±20 A, both in commands and in feedback.
const FULL_SCALE_COUNTS: f32 = 16_384.0;
const COUNTS_PER_MA: f32 = FULL_SCALE_COUNTS / MotorCurrent::FULL_SCALE_MA;
const LAST_ANGLE: u16 = 8_191;

/// Encodes the currents of controllers 1 to 4, rounded towards zero.
pub fn encode_currents(currents: [MotorCurrent; 4]) -> CanFrame {
    let [one, two, three, four] = currents.map(counts);
    CanFrame::new(
        COMMAND_ID,
        [
            one[0], one[1], two[0], two[1], three[0], three[1], four[0], four[1],
        ],
    )
}

/// A `MotorCurrent` is finite and within ±20 A, so the conversion cannot overflow. The core converts to 32 bits in one
/// instruction, to 16 in many.
fn counts(current: MotorCurrent) -> [u8; 2] {
    ((current.ma() * COUNTS_PER_MA) as i32 as i16).to_be_bytes()
}

/// Decodes a feedback frame. Returns `None` unless it has eight bytes and an angle within one turn.
pub fn decode_feedback(frame: &CanFrame, ts_us: u64) -> Option<WheelFeedback> {
    let [
        angle_h,
        angle_l,
        rpm_h,
        rpm_l,
        current_h,
        current_l,
        temperature_c,
        _,
    ] = frame.full_payload()?;
    let rotor_angle = u16::from_be_bytes([angle_h, angle_l]);
    (rotor_angle <= LAST_ANGLE).then(|| WheelFeedback {
        rotor_angle,
        rpm: i16::from_be_bytes([rpm_h, rpm_l]),
        current_ma: f32::from(i16::from_be_bytes([current_h, current_l])) / COUNTS_PER_MA,
        temperature_c,
        frozen: false,
        doubtful: false,
        age_us: 0,
        ts_us,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn current(counts: f32) -> MotorCurrent {
        MotorCurrent::clamped(counts * 20_000.0 / 16_384.0, f32::INFINITY)
    }

    /// A vector of docs/hardware.md#test-vectors.
    #[test]
    fn currents_are_packed_as_the_datasheet_shows() {
        let frame = encode_currents([1_000.0, -1_000.0, 16_384.0, -16_384.0].map(current));
        assert_eq!(frame.id().raw(), 0x200);
        assert_eq!(
            frame.payload(),
            [0x03, 0xE8, 0xFC, 0x18, 0x40, 0x00, 0xC0, 0x00]
        );
    }

    #[test]
    fn feedback_is_unpacked_as_the_datasheet_shows() {
        let id = StandardId::new(0x201).unwrap();
        let frame = CanFrame::new(id, [0x1F, 0xFF, 0xFE, 0x0C, 0x20, 0x00, 41, 0]);
        let feedback = decode_feedback(&frame, 7).unwrap();
        assert_eq!(feedback.rotor_angle, 8_191);
        assert_eq!(feedback.rpm, -500);
        assert_eq!(feedback.current_ma, 10_000.0);
        assert_eq!(feedback.temperature_c, 41);
        assert_eq!(feedback.ts_us, 7);
    }

    #[test]
    fn an_impossible_angle_or_a_short_frame_is_rejected() {
        let id = StandardId::new(0x201).unwrap();
        let angle = CanFrame::new(id, [0x20, 0x00, 0, 0, 0, 0, 0, 0]);
        let short = CanFrame::from_payload(id, &[0; 7]).unwrap();
        assert_eq!(decode_feedback(&angle, 0), None);
        assert_eq!(decode_feedback(&short, 0), None);
    }

    #[test]
    fn feedback_has_identifier_0x200_plus_the_controller_number() {
        let feedback_id = |number| EscId::new(number).map(|esc| esc.feedback_id().raw());
        assert_eq!(feedback_id(1), Some(0x201));
        assert_eq!(feedback_id(4), Some(0x204));
        assert_eq!(EscId::new(0), None);
        assert_eq!(EscId::new(5), None);
    }
}
