//! CRC-8/MAXIM-DOW.

/// 0x31 in reflected form.
const POLYNOMIAL: u8 = 0x8C;

/// CRC of each single byte, which is also the state after a byte of zero.
static TABLE: [u8; 256] = after_zeros(1);

/// CRC over `bytes`. Over a whole frame, its CRC included, it is 0.
///
/// ```
/// assert_eq!(robot_app::link::crc8(b"123456789"), 0xA1);
/// ```
pub fn crc8(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |crc, byte| next(crc, *byte))
}

/// State of the CRC after one more byte.
pub(super) fn next(crc: u8, byte: u8) -> u8 {
    let entry = TABLE.get(usize::from(crc ^ byte));
    entry.copied().unwrap_or_default()
}

/// State of the CRC after `len` bytes of zero, by its state before.
pub(super) const fn after_zeros(len: usize) -> [u8; 256] {
    let mut table = [0; 256];
    let mut state = 0_u8;
    let mut rest: &mut [u8] = &mut table;
    while let Some((slot, others)) = rest.split_first_mut() {
        let mut crc = state;
        let mut zeros = 0_usize;
        while zeros < len {
            crc = crc_of(crc);
            zeros = zeros.wrapping_add(1);
        }
        *slot = crc;
        state = state.wrapping_add(1);
        rest = others;
    }
    table
}

/// CRC of a single byte.
const fn crc_of(byte: u8) -> u8 {
    let mut crc = byte;
    let mut bit = 0_u8;
    while bit < 8 {
        let low = crc & 1;
        crc >>= 1;
        if low == 1 {
            crc ^= POLYNOMIAL;
        }
        bit = bit.wrapping_add(1);
    }
    crc
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the CRC catalogue.
    #[test]
    fn the_crc_matches_the_catalogue() {
        assert_eq!(crc8(b"123456789"), 0xA1);
        assert_eq!(crc8(b""), 0);
    }

    #[test]
    fn a_frame_with_its_crc_leaves_nothing() {
        let mut frame = b"123456789".to_vec();
        frame.push(crc8(&frame));
        assert_eq!(crc8(&frame), 0);
    }
}
