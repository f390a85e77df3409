//! Frames of the servos' protocol, as in the manufacturer's SDK.
//!
//! ```text
//! request   FF FF id length instruction parameters… checksum
//! answer    FF FF id length status      data…       checksum
//! ```
//!
//! The length counts what follows it. The checksum is the complement of the low byte of the sum from the id on.

/// All servos.
pub(super) const BROADCAST: u8 = 0xFE;
/// Two header bytes, id and length.
pub(super) const HEADER: usize = 4;
/// Most bytes after the length.
const MOST_AFTER_LENGTH: usize = 255;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instruction {
    Ping = 0x01,
    Read = 0x02,
    Write = 0x03,
    RegWrite = 0x04,
    Action = 0x05,
    SyncRead = 0x82,
    SyncWrite = 0x83,
}

/// Returns a request. `None` if it is longer than a frame can be.
pub(super) fn request(id: u8, instruction: Instruction, parameters: &[u8]) -> Option<Vec<u8>> {
    let length = parameters.len() + 2;
    let length = u8::try_from(length).ok()?;
    let mut bytes = vec![0xFF, 0xFF, id, length, instruction as u8];
    bytes.extend(parameters);
    bytes.push(checksum(&bytes[2..]));
    Some(bytes)
}

/// Returns the checksum of the bytes from the id on.
pub(super) fn checksum(bytes: &[u8]) -> u8 {
    !bytes.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte))
}

/// Number of bytes of an answer with so many bytes of data.
pub(super) fn answer_size(data: usize) -> usize {
    HEADER + 2 + data
}

/// Number of bytes of the longest frame.
pub(super) const fn longest() -> usize {
    HEADER + MOST_AFTER_LENGTH
}

/// A frame whose checksum is right, header included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Frame(Vec<u8>);

impl Frame {
    /// Takes a frame whose header, length and checksum were checked.
    pub(super) fn new(checked: &[u8]) -> Self {
        Self(checked.to_vec())
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }

    pub(super) fn id(&self) -> u8 {
        self.0.get(2).copied().unwrap_or(BROADCAST)
    }

    /// The byte after the length: status of an answer, instruction of a request.
    pub(super) fn status(&self) -> u8 {
        self.0.get(HEADER).copied().unwrap_or(u8::MAX)
    }

    pub(super) fn data(&self) -> &[u8] {
        let end = self.0.len().saturating_sub(1);
        self.0.get(HEADER + 1..end).unwrap_or_default()
    }
}
