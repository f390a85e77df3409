use super::*;

/// A slot by docs/parameters.md with a checksum from zlib: key 4, version 1, three values, variant 2.
fn by_hand() -> [u8; SLOT_BYTES] {
    let mut bytes = [BLANK; SLOT_BYTES];
    bytes[4..8].copy_from_slice(&[4, 1, 3, 2]);
    bytes[8..12].copy_from_slice(&[0, 0, 0x80, 0x3F]);
    bytes[12..16].copy_from_slice(&[0; 4]);
    bytes[124..].copy_from_slice(&[0xA4, 0x53, 0xDF, 0x1C]);
    bytes
}

fn the_record() -> Record {
    let id = RecordId { key: 4, variant: 2 };
    Record {
        id,
        version: 1,
        values: [1.0_f32.to_bits(), 0, u32::MAX].into_iter().collect(),
    }
}

#[test]
fn a_slot_has_the_documented_layout() {
    assert_eq!(Slot::from_record(&the_record()).bytes, by_hand());
    let slot = Slot { bytes: by_hand() };
    assert!(slot.is_intact() && !slot.is_blank());
    assert_eq!(slot.record(), the_record());
}

/// Guard and proof are exempt, as they only count as blank or not.
#[test]
fn every_flipped_bit_is_detected() {
    for bit in 0..SLOT_BYTES * 8 {
        let mut slot = Slot { bytes: by_hand() };
        slot.bytes[bit / 8] ^= 1 << (bit % 8);
        let is_mark = bit < 32 || (120 * 8..124 * 8).contains(&bit);
        assert_eq!(slot.is_intact(), is_mark, "bit {bit}");
        assert_eq!(slot.is_proven(), (120 * 8..124 * 8).contains(&bit));
        assert_eq!(
            slot.holds_the_same(&Slot { bytes: by_hand() }),
            is_mark,
            "bit {bit}"
        );
    }
}

#[test]
fn blank_and_cleared_slots_are_not_records() {
    let blank = Slot {
        bytes: [BLANK; SLOT_BYTES],
    };
    assert!(blank.is_blank() && !blank.is_intact() && !blank.is_proven());
    let cleared = Slot {
        bytes: [0; SLOT_BYTES],
    };
    assert!(!cleared.is_blank() && !cleared.is_intact() && cleared.is_proven());
}

#[test]
fn a_record_has_at_most_28_values() {
    let mut record = the_record();
    record.values = (0..28).map(|index| index * 0x0101_0101).collect();
    (record.id.key, record.version, record.id.variant) = (200, 9, 255);
    let slot = Slot::from_record(&record);
    assert_eq!(slot.bytes[124..], 0x04DC_7C6F_u32.to_le_bytes());
    assert_eq!(slot.record(), record);
    let mut claims_more = slot;
    claims_more.bytes[6] = 29;
    let crc = checksum(&claims_more.bytes[BODY_AT..PROOF_AT]);
    claims_more.bytes[CRC_AT..].copy_from_slice(&crc.to_le_bytes());
    assert!(!claims_more.is_intact());
}

/// The third value is all ones, so it needs no programming.
#[test]
fn blank_words_at_the_end_are_not_programmed() {
    assert_eq!(Slot::from_record(&the_record()).body(), &by_hand()[4..16]);
    let mut full = the_record();
    full.values = [7; MAX_VALUES].into_iter().collect();
    assert_eq!(Slot::from_record(&full).body().len(), 4 * 29);
}
