use super::*;
use crate::params::slot::BLANK;

/// As docs/parameters.md says it, generation 7, the checksum computed with zlib.
const COPY: [u8; 16] = *b"PRM1\x07\0\0\0\xF8\xFF\xFF\xFF\x44\xB1\xDB\x7C";

fn head_with(at: usize, bytes: &[u8]) -> Head {
    let mut head = Head {
        bytes: [BLANK; SLOT_BYTES],
    };
    head.bytes[at..at + bytes.len()].copy_from_slice(bytes);
    head
}

#[test]
fn a_head_is_committed_as_documented() {
    assert_eq!(commitment(7), COPY);
}

#[test]
fn one_copy_of_the_head_is_enough() {
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

/// A power cut in an erase may leave a sector that reads blank, or zeros.
#[test]
fn only_the_mark_makes_a_blank_sector_clean() {
    assert!(head_with(0, b"\xC1\xEA\x5E\xD0").is_clean());
    assert!(!head_with(0, &[BLANK; 4]).is_clean());
    assert!(!head_with(0, &[0; 4]).is_clean());
    let mut opened = head_with(0, b"\xC1\xEA\x5E\xD0");
    opened.bytes[4] = 0x7F;
    assert!(!opened.is_clean());
}

/// What a cut in a change of sectors, a cut while a head is cleared and worn-out cells leave is no damage.
#[test]
fn only_a_head_with_two_wrong_copies_is_ruined() {
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

/// Two stuck bits a word are nothing, in a cleared word as in a blank one; three are something.
#[test]
fn a_head_holds_something_beyond_two_stuck_bits_a_word() {
    for (word, holds) in [
        (0x0000_0003_u32, false),
        (0x0000_0007, true),
        (0xFFFF_FFFC, false),
        (0xFFFF_FFF8, true),
    ] {
        let mut copies = [0; 8];
        copies[..4].copy_from_slice(&word.to_le_bytes());
        assert_eq!(holds_something(&copies), holds, "{word:x}");
    }
}

/// Code of another firmware, an erased or cleared place and noise have none of them; a head of which bits are wrong, or
/// only one word is left, has.
#[test]
fn a_head_of_the_store_is_known_by_its_marks() {
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
fn slots_lie_128_bytes_apart_and_sectors_16_kib() {
    assert_eq!(offset(0, 1), 0x80);
    assert_eq!(offset(1, 0), 0x4000);
    assert_eq!(offset(2, 127), 0xBF80);
}
