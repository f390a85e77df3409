//! The settings that the soak may change while the robot goes on driving, and the frames for them (docs/tuning.md).

use robot_plant::wire::CanFrame;

use super::rng::Rng;

/// Identifiers of the tuning channel.
pub const WRITE: u32 = 0x7A0;
pub const READ: u32 = 0x7A1;
pub const REPLY: u32 = 0x7A2;
/// Opcodes, the first byte of a frame. The simulation shares no code with the firmware, so a test compares these with the
/// firmware's table.
pub const WRITE_GEOMETRY: u8 = 0x10;
pub const READ_GEOMETRY: u8 = 0x11;
pub const WRITE_SETTING: u8 = 0x20;
pub const READ_SETTING: u8 = 0x21;
pub const READ_STORE: u8 = 0x31;
pub const BRING_UP: u8 = 0x40;

/// A setting by group and index.
pub type Setting = (u8, u8);

/// The settings that the soak changes, with their limits.
pub const RANGES: [(Setting, f64, f64); 6] = [
    ((1, 1), 0.4, 0.45),
    ((2, 1), 3.5, 4.5),
    ((6, 0), -2.0, 2.0),
    ((6, 1), -2.0, 2.0),
    ((7, 1), 0.15, 0.3),
    ((7, 2), 0.005, 0.02),
];

/// The initial values of these groups: those of the emulated robot, but no default where the soak changes a setting.
pub const INITIAL_VALUES: [(u8, &[f32]); 4] = [
    (1, &[0.075, 0.43, 3591.0 / 187.0, 1.0, -1.0]),
    (2, &[1.5, 3.75, 60_000.0, 8_000.0, 1_000.0, 50_000.0]),
    (6, &[0.5, -0.5, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
    (7, &[40.0, 0.25, 0.015, 1.0]),
];

/// Bits of the initial value, an `f32`.
pub fn initial((group, index): Setting) -> Option<u32> {
    let (_, values) = INITIAL_VALUES.iter().find(|(number, _)| *number == group)?;
    values.get(usize::from(index)).map(|value| value.to_bits())
}

/// A request to set one of them to a random value.
pub fn random_write(rng: &mut Rng) -> CanFrame {
    let [n, ..] = rng.bits().to_le_bytes();
    let ((group, index), low, high) = RANGES[usize::from(n) % RANGES.len()];
    let [a, b, c, d] = (rng.between(low, high) as f32).to_le_bytes();
    frame(WRITE, [WRITE_SETTING, group, index, 0, a, b, c, d])
}

/// Requests to read all of them.
pub fn read_requests() -> impl Iterator<Item = CanFrame> {
    let settings = RANGES.into_iter().map(|(setting, ..)| setting);
    settings.map(|(group, index)| frame(READ, [READ_SETTING, group, index, 0, 0, 0, 0, 0]))
}

/// A request for the number of unsaved groups.
pub fn store_status_request() -> CanFrame {
    frame(READ, [READ_STORE, 0, 0, 0, 0, 0, 0, 0])
}

/// The setting and its new bits, if the frame is a request to write one of them.
pub fn parse_write(frame: &CanFrame) -> Option<(Setting, u32)> {
    let asks = frame.id == WRITE && frame.dlc == 8 && !frame.remote && !frame.extended;
    let of_reply = CanFrame {
        id: REPLY,
        ..*frame
    };
    parse_value(&of_reply, WRITE_SETTING)
        .filter(|(_, bits)| asks && f32::from_bits(*bits).is_finite())
}

/// The setting and its bits, if the frame is a reply to `command`.
pub fn parse_value(frame: &CanFrame, command: u8) -> Option<(Setting, u32)> {
    let [first, group, index, _, a, b, c, d] = frame.data;
    let known = RANGES
        .iter()
        .any(|(setting, ..)| *setting == (group, index));
    let fits = frame.id == REPLY && first == command && known;
    fits.then_some(((group, index), u32::from_le_bytes([a, b, c, d])))
}

/// The number of unsaved groups, if the frame is a reply with it.
pub fn parse_unsaved(frame: &CanFrame) -> Option<u8> {
    let [first, _, _, unsaved, ..] = frame.data;
    (frame.id == REPLY && first == READ_STORE).then_some(unsaved)
}

fn frame(id: u32, data: [u8; 8]) -> CanFrame {
    CanFrame {
        id,
        extended: false,
        remote: false,
        dlc: 8,
        data,
    }
}

#[cfg(test)]
mod tests {
    use robot_app::tuning::{READ_ID, REPLY_ID, WRITE_ID, opcode};

    use super::*;

    #[test]
    fn the_numbers_are_those_of_the_firmware() {
        let ids = [WRITE_ID, READ_ID, REPLY_ID].map(|id| u32::from(id.raw()));
        assert_eq!([WRITE, READ, REPLY], ids);
        for (ours, firmware) in [
            (WRITE_GEOMETRY, opcode::WRITE_GEOMETRY),
            (READ_GEOMETRY, opcode::READ_GEOMETRY),
            (WRITE_SETTING, opcode::WRITE_PARAMETER),
            (READ_SETTING, opcode::READ_PARAMETER),
            (READ_STORE, opcode::READ_STORE),
            (BRING_UP, opcode::BRING_UP),
        ] {
            assert_eq!(ours, firmware);
        }
    }
}
