//! CRC-32 as in zip and Ethernet (CRC-32/ISO-HDLC).

/// In reflected form.
const POLYNOMIAL: u32 = 0xEDB8_8320;

/// Computes the CRC of bytes, without a table and out of line: flash is scarce, and a slot takes only 30 µs.
#[inline(never)]
pub fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc = shifted(crc ^ u32::from(*byte), u8::BITS);
    }
    !crc
}

/// Computes the CRC of words, each little-endian.
#[inline(never)]
pub fn checksum_of_words(words: &[u32]) -> u32 {
    let mut crc = u32::MAX;
    for word in words {
        crc = shifted(crc ^ *word, u32::BITS);
    }
    !crc
}

#[inline]
fn shifted(mut crc: u32, bits: u32) -> u32 {
    for _ in 0..bits {
        let mask = 0_u32.wrapping_sub(crc & 1);
        crc = crc >> 1 ^ POLYNOMIAL & mask;
    }
    crc
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

    #[test]
    fn words_have_the_checksum_of_their_bytes() {
        let words = [0x3433_3231, 0x3837_3635];
        assert_eq!(checksum_of_words(&words), checksum(b"12345678"));
    }
}
