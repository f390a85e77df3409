use super::*;
use crate::params::slot::BLANK;

/// A copy by docs/parameters.md with a checksum from zlib: generation 7.
const COPY: [u8; 16] = *b"PRM1\x07\0\0\0\xF8\xFF\xFF\xFF\x44\xB1\xDB\x7C";

fn head_with(at: usize, bytes: &[u8]) -> Head {
    let mut head = Head {
        bytes: [BLANK; SLOT_BYTES],
    };
    head.bytes[at..at + bytes.len()].copy_from_slice(bytes);
    head
}

#[test]
fn a_head_has_the_documented_layout() {
    assert_eq!(commitment(7), COPY);
}

#[test]
fn one_intact_copy_of_the_head_is_enough() {
    assert_eq!(head_with(8, &COPY).generation(), Some(7));
    assert_eq!(head_with(24, &COPY).generation(), Some(7));
    assert_eq!(head_with(12, &COPY).generation(), None);
    for bit in 0..COPY.len() * 8 {
        let mut flipped = COPY;
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(head_with(8, &flipped).generation(), None, "bit {bit}");
        let mut both = head_with(8, &flipped);
        both.bytes[24..40].copy_from_slice(&COPY);
        assert_eq!(both.generation(), Some(7));
    }
}

/// An interrupted erase may leave a sector that reads blank or as zeros.
#[test]
fn a_blank_sector_is_clean_only_with_its_mark() {
    assert!(head_with(0, b"\xC1\xEA\x5E\xD0").is_clean());
    assert!(!head_with(0, &[BLANK; 4]).is_clean());
    assert!(!head_with(0, &[0; 4]).is_clean());
    let mut opened = head_with(0, b"\xC1\xEA\x5E\xD0");
    opened.bytes[4] = 0x7F;
    assert!(!opened.is_clean());
}

/// An interrupted rotation, an interrupted clearing of a head, and worn-out cells do not count as damage.
#[test]
fn a_head_is_ruined_only_if_both_copies_are_wrong() {
    let mut flipped = COPY;
    flipped[5] ^= 1;
    let with_second = |mut head: Head, copy: &[u8]| {
        head.bytes[24..40].copy_from_slice(copy);
        head
    };
    assert!(with_second(head_with(8, &flipped), &flipped).is_ruined());
    assert!(head_with(0, &[0x5A; 128]).is_ruined());
    assert!(!head_with(0, b"").is_ruined());
    assert!(!head_with(8, &flipped).is_ruined());
    assert!(!head_with(0, &[0; 44]).is_ruined());
    assert!(!with_second(head_with(0, &[0; 44]), &flipped).is_ruined());
    let mut stuck = [0; 44];
    (stuck[9], stuck[27]) = (0x80, 0x01);
    assert!(!head_with(0, &stuck).is_ruined());
}

/// Two stuck bits in a word are ignored, in a cleared word as in a blank one. Three are not.
#[test]
fn up_to_two_stuck_bits_in_a_word_count_as_blank() {
    for (word, holds) in [
        (0x0000_0003_u32, false),
        (0x0000_0007, true),
        (0xFFFF_FFFC, false),
        (0xFFFF_FFF8, true),
    ] {
        let mut copies = [0; 8];
        copies[..4].copy_from_slice(&word.to_le_bytes());
        assert_eq!(has_data(&copies), holds, "{word:x}");
    }
}

/// Code of another firmware, erased or cleared words, and noise have no mark. A head with wrong bits, or with only
/// one word left, has one.
#[test]
fn a_head_of_the_store_is_recognised_by_its_marks() {
    let mut hurt = *b"\xC1\xEA\x5E\xD0";
    hurt[2] ^= 0x3F;
    assert!(head_with(0, &hurt).has_marks());
    assert!(head_with(8, b"PRM1").has_marks());
    assert!(head_with(24, b"PRM2").has_marks());
    // The vector table of an image for this chip: stack pointer, then handlers.
    let table =
        *b"\x00\x00\x02\x20\xd1\x01\x00\x08\x15\x33\x00\x08\x17\x33\x00\x08\x19\x33\x00\x08";
    // Thumb code: push, mov, bl, cmp, beq, ldr, bx.
    let code = *b"\x10\xb5\x04\x46\xff\xf7\xf8\xff\x00\x28\x02\xd0\x20\x68\x10\xbd\x00\x20\x70\x47";
    for other in [&table[..], &code, &[0x5A; 128], &[0; 128], &[BLANK; 128]] {
        assert!(!head_with(0, other).has_marks(), "{other:X?}");
    }
}

#[test]
fn slots_are_128_bytes_and_sectors_16_kib_apart() {
    assert_eq!(offset(0, 1), 0x80);
    assert_eq!(offset(1, 0), 0x4000);
    assert_eq!(offset(2, 127), 0xBF80);
}
