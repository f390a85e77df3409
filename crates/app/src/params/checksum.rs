//! CRC-32 as in zip and Ethernet (CRC-32/ISO-HDLC).

/// In reflected form.
const POLYNOMIAL: u32 = 0xEDB8_8320;

/// Computes the CRC without a table and out of line: flash is scarce, and a slot takes only 30 µs.
#[inline(never)]
pub(super) fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            let mask = 0_u32.wrapping_sub(crc & 1);
            crc = crc >> 1 ^ POLYNOMIAL & mask;
        }
    }
    !crc
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the CRC catalogue.
    #[test]
    fn the_checksum_matches_the_catalogue() {
        assert_eq!(checksum(b"123456789"), 0xCBF4_3926);
        assert_eq!(checksum(b""), 0);
    }
}
