//! The robot's report on a bank of its black box (docs/tuning.md, `44`).

use robot_app::domain::{BankState, EventKind};

/// What a bank holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BankReport {
    pub state: BankState,
    pub kind: EventKind,
    /// Number of its recording.
    pub number: u16,
    /// Size of the bank.
    pub bytes: usize,
    /// Version of its layout.
    pub layout: u8,
    /// Events overwritten since boot before anybody had released them, up to 255.
    pub overwritten: u8,
}

impl BankReport {
    /// Parses the bytes after the command. A state or kind that this tool does not know counts as empty.
    pub(super) fn from_bytes([_, state, low, high, size, layout, overwritten]: [u8; 7]) -> Self {
        Self {
            state: BankState::from_code(state & 15).unwrap_or_default(),
            kind: EventKind::from_code(state >> 4).unwrap_or_default(),
            number: u16::from_le_bytes([low, high]),
            bytes: usize::from(size) * 256,
            layout,
            overwritten,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In docs/tuning.md bank 1 holds a partial stop, number 0x0203.
    #[test]
    fn the_documented_bytes_are_understood() {
        let expected = BankReport {
            state: BankState::Event,
            kind: EventKind::PartialStop,
            number: 0x0203,
            bytes: 14_336,
            layout: 1,
            overwritten: 4,
        };
        let report = BankReport::from_bytes([1, 0x23, 3, 2, 56, 1, 4]);
        assert_eq!(report, expected);
    }
}
