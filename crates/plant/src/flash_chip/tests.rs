use std::collections::BTreeSet;

use embedded_storage::nor_flash::{NorFlash, ReadNorFlash};

use super::*;

const SECTOR_1: u32 = 0x0800_4000;
const SECTOR_2: u32 = 0x0800_8000;

fn word(chip: &mut FlashChip, address: u32) -> u32 {
    let mut bytes = [0; 4];
    chip.read(address, &mut bytes).unwrap();
    u32::from_le_bytes(bytes)
}

fn sector_1(chip: &mut FlashChip) -> Vec<u8> {
    let mut bytes = vec![0; 0x4000];
    chip.read(SECTOR_1, &mut bytes).unwrap();
    bytes
}

/// docs/hardware.md#flash.
#[test]
fn the_sectors_lie_where_the_reference_manual_puts_them() {
    let starts: Vec<u32> = (0..12).map(|n| sector_range(n).unwrap().start).collect();
    let expected = [
        0x0800_0000,
        0x0800_4000,
        0x0800_8000,
        0x0800_C000,
        0x0801_0000,
        0x0802_0000,
        0x0804_0000,
        0x0806_0000,
        0x0808_0000,
        0x080A_0000,
        0x080C_0000,
        0x080E_0000,
    ];
    assert_eq!(starts, expected);
    assert_eq!(sector_range(11).unwrap().end, 0x0810_0000, "1 MiB");
    assert_eq!(sector_range(12), None);
}

#[test]
fn bits_are_programmed_from_1_to_0_only() {
    let mut chip = FlashChip::parameters(1);
    chip.program_word(SECTOR_1, 0xF0F0_FFFF).unwrap();
    chip.program_word(SECTOR_1, 0x00FF_00FF).unwrap();
    assert_eq!(word(&mut chip, SECTOR_1), 0x00F0_00FF);
    assert_eq!(chip.programs(), 2);
}

#[test]
fn an_erase_blanks_its_own_sector_alone_and_is_counted() {
    let mut chip = FlashChip::parameters(1);
    for sector in PARAMETER_SECTORS {
        let range = sector_range(sector).unwrap();
        chip.program_word(range.start, 0).unwrap();
        chip.program_word(range.end - 4, 0).unwrap();
    }
    chip.erase(2).unwrap();
    for sector in PARAMETER_SECTORS {
        let range = sector_range(sector).unwrap();
        let expected = if sector == 2 { u32::MAX } else { 0 };
        assert_eq!(word(&mut chip, range.start), expected, "{sector}");
        assert_eq!(word(&mut chip, range.end - 4), expected, "{sector}");
        assert_eq!(chip.erases(sector), u32::from(sector == 2), "{sector}");
    }
}

#[test]
fn an_address_that_is_no_word_is_refused_and_counts_as_no_step() {
    let mut chip = FlashChip::parameters(1);
    assert_eq!(
        chip.program_word(SECTOR_1 + 2, 0),
        Err(FlashError::NotAligned(SECTOR_1 + 2))
    );
    let below = SECTOR_1 - 4;
    assert_eq!(
        chip.program_word(below, 0),
        Err(FlashError::OutOfRange(below))
    );
    let end = 0x0801_0000;
    assert_eq!(
        chip.read(end - 1, &mut [0; 2]),
        Err(FlashError::OutOfRange(end - 1))
    );
    for sector in [0, 4, 12] {
        assert_eq!(chip.erase(sector), Err(FlashError::OtherSector(sector)));
    }
    assert_eq!(chip.steps(), 0);
}

#[test]
fn without_power_nothing_is_read_or_changed_until_it_is_back() {
    let mut chip = FlashChip::parameters(1);
    chip.cut_at(1, Phase::Before);
    chip.program_word(SECTOR_1, 1).unwrap();
    assert!(chip.is_powered());
    let lost = Err(FlashError::PowerLost);
    assert_eq!(chip.program_word(SECTOR_1 + 4, 2), lost);
    assert!(!chip.is_powered());
    assert_eq!(chip.program_word(SECTOR_1 + 8, 3), lost);
    assert_eq!(chip.erase(1), lost);
    assert_eq!(chip.read(SECTOR_1, &mut [0]), lost);
    chip.power_up();
    let words = [0, 4, 8].map(|offset| word(&mut chip, SECTOR_1 + offset));
    assert_eq!(words, [1, u32::MAX, u32::MAX]);
    assert_eq!((chip.steps(), chip.programs(), chip.erases(1)), (2, 1, 0));
}

#[test]
fn a_step_cut_at_its_end_is_done_but_reported_as_failed() {
    let mut chip = FlashChip::parameters(1);
    chip.cut_at(0, Phase::After);
    assert_eq!(chip.program_word(SECTOR_1, 7), Err(FlashError::PowerLost));
    chip.power_up();
    assert_eq!(word(&mut chip, SECTOR_1), 7);
    chip.cut_at(chip.steps(), Phase::After);
    assert_eq!(chip.erase(1), Err(FlashError::PowerLost));
    chip.power_up();
    assert_eq!(word(&mut chip, SECTOR_1), u32::MAX);
}

fn torn_word(seed: u64, old: u32, value: u32) -> FlashChip {
    let mut chip = FlashChip::parameters(seed);
    chip.program_word(SECTOR_1, old).unwrap();
    chip.cut_at(1, Phase::Middle);
    assert!(chip.program_word(SECTOR_1, value).is_err());
    chip.power_up();
    chip
}

#[test]
fn a_torn_word_differs_only_in_bits_to_be_cleared() {
    let (old, value) = (0xFFFF_0FFF, 0x1234_5678);
    let read: BTreeSet<u32> = (0..400)
        .map(|seed| {
            let mut chip = torn_word(seed, old, value);
            let read = word(&mut chip, SECTOR_1);
            assert_eq!(read & !old, 0, "a bit rose: {read:#010x}");
            assert_eq!(read & old & value, old & value, "{read:#010x}");
            assert_eq!(word(&mut chip, SECTOR_1 + 4), u32::MAX);
            read
        })
        .collect();
    assert!(read.contains(&old), "as if nothing had happened");
    assert!(read.contains(&(old & value)), "as if it had been done");
    assert!(read.len() > 100, "{}", read.len());
}

#[test]
fn an_unstable_bit_changes_between_reads_until_it_is_programmed() {
    let wavering = |chip: &mut FlashChip| -> bool {
        let first = word(chip, SECTOR_1);
        (0..20).any(|_| word(chip, SECTOR_1) != first)
    };
    let unstable: Vec<u64> = (0..100)
        .filter(|&seed| wavering(&mut torn_word(seed, u32::MAX, 0)))
        .collect();
    assert!((20..100).contains(&unstable.len()), "{unstable:?}");
    for seed in unstable {
        let mut chip = torn_word(seed, u32::MAX, 0);
        chip.program_word(SECTOR_1, u32::MAX).unwrap();
        assert!(wavering(&mut chip), "ones mend nothing");
        chip.program_word(SECTOR_1, 0).unwrap();
        assert_eq!(word(&mut chip, SECTOR_1), 0);
        assert!(!wavering(&mut chip));
    }
}

fn torn_erase(seed: u64) -> FlashChip {
    let mut chip = FlashChip::parameters(seed);
    chip.set_contents(SECTOR_1, &[0x5A; 0x4000]).unwrap();
    chip.program_word(SECTOR_2, 0).unwrap();
    chip.cut_at(1, Phase::Middle);
    assert!(chip.erase(1).is_err());
    chip.power_up();
    chip
}

#[test]
fn a_torn_erase_leaves_anything_from_old_to_blank_in_its_sector_and_wears_it() {
    let (mut old_bits, mut noise, mut blank) = (0, 0, 0);
    for seed in 0..40 {
        let mut chip = torn_erase(seed);
        assert_eq!(chip.erases(1), 1);
        assert_eq!(word(&mut chip, SECTOR_2), 0, "the neighbour");
        let bytes = sector_1(&mut chip);
        let ones: u32 = bytes.iter().map(|byte| byte.count_ones()).sum();
        if bytes.iter().all(|byte| byte & !0x5A == 0) {
            old_bits += 1;
        } else if ones > 0x4000 * 8 - 16 {
            blank += 1;
        } else {
            let share = f64::from(ones) / f64::from(0x4000 * 8);
            assert!((0.48..0.52).contains(&share), "{share}");
            assert_ne!(sector_1(&mut chip), bytes, "half of the bits waver");
            noise += 1;
        }
        chip.erase(1).unwrap();
        assert!(sector_1(&mut chip).iter().all(|&byte| byte == 0xFF));
    }
    assert!(
        old_bits >= 3 && noise >= 10 && blank >= 3,
        "{old_bits} {noise} {blank}"
    );
}

#[test]
fn the_same_seed_tears_the_same_way() {
    let read = |seed| sector_1(&mut torn_erase(seed));
    let different: BTreeSet<Vec<u8>> = (0..8).map(read).collect();
    assert!(different.len() > 4);
    for seed in 0..8 {
        assert_eq!(read(seed), read(seed));
    }
    let mut chip = FlashChip::parameters(1);
    chip.cut_at(0, Phase::Middle);
    chip.reseed(5);
    let _ = chip.erase(2);
    chip.power_up();
    let mut other = FlashChip::parameters(5);
    other.cut_at(0, Phase::Middle);
    let _ = other.erase(2);
    other.power_up();
    assert_eq!(word(&mut chip, SECTOR_2), word(&mut other, SECTOR_2));
}

#[test]
fn a_stuck_bit_reads_the_same_whatever_is_written() {
    let mut chip = FlashChip::parameters(1);
    let stuck = |address, bit, value| StuckBit {
        address,
        bit,
        value,
    };
    chip.stick(stuck(SECTOR_1 + 1, 0, true));
    chip.stick(stuck(SECTOR_1 + 3, 7, false));
    assert_eq!(word(&mut chip, SECTOR_1), 0x7FFF_FFFF);
    chip.program_word(SECTOR_1, 0).unwrap();
    assert_eq!(word(&mut chip, SECTOR_1), 0x0000_0100);
    chip.erase(1).unwrap();
    assert_eq!(word(&mut chip, SECTOR_1), 0x7FFF_FFFF);
    assert_eq!(word(&mut chip, SECTOR_1 + 4), u32::MAX);
}

#[test]
fn an_erase_that_fails_leaves_words_and_reports_no_error() {
    let zeros = |chip: &mut FlashChip| -> usize {
        let bytes = sector_1(chip);
        bytes.as_chunks().0.iter().filter(|w| **w == [0; 4]).count()
    };
    let mut chip = FlashChip::parameters(1);
    chip.set_contents(SECTOR_1, &[0; 0x4000]).unwrap();
    chip.set_erase_fault(1, Some(EraseFault::DoesNothing));
    chip.erase(1).unwrap();
    assert_eq!(zeros(&mut chip), 4096);
    chip.set_erase_fault(1, Some(EraseFault::LeavesSomeWords));
    chip.erase(1).unwrap();
    let left = zeros(&mut chip);
    assert!((20..200).contains(&left), "{left}");
    chip.set_erase_fault(1, None);
    chip.erase(1).unwrap();
    assert_eq!(zeros(&mut chip), 0);
    assert_eq!(chip.erases(1), 3);
}

#[test]
fn the_store_sees_sectors_1_to_3_from_offset_0() {
    let mut chip = FlashChip::parameters(1);
    assert_eq!(chip.capacity(), 0xC000);
    NorFlash::write(&mut chip, 0x4008, &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
    assert_eq!(word(&mut chip, SECTOR_2 + 8), 0x0403_0201);
    assert_eq!(word(&mut chip, SECTOR_2 + 12), 0x0807_0605);
    let mut bytes = [0; 3];
    ReadNorFlash::read(&mut chip, 0x400B, &mut bytes).unwrap();
    assert_eq!(bytes, [4, 5, 6]);
    NorFlash::erase(&mut chip, 0x4000, 0xC000).unwrap();
    assert_eq!([0, 1, 2, 3, 4].map(|n| chip.erases(n)), [0, 0, 1, 1, 0]);
    assert_eq!(word(&mut chip, SECTOR_2 + 8), u32::MAX);
}

#[test]
fn the_store_cannot_reach_the_code() {
    let mut chip = FlashChip::parameters(1);
    let out = |offset| Err(FlashError::OutOfRange(SECTOR_1 + offset));
    assert_eq!(NorFlash::write(&mut chip, 0xC000, &[0; 4]), out(0xC000));
    assert_eq!(NorFlash::erase(&mut chip, 0x8000, 0x1_0000), out(0x8000));
    assert_eq!(
        ReadNorFlash::read(&mut chip, 0xBFFF, &mut [0; 2]),
        out(0xBFFF)
    );
    let unaligned = Err(FlashError::NotAligned(SECTOR_1 + 4));
    assert_eq!(NorFlash::write(&mut chip, 4, &[0; 6]), unaligned);
    assert_eq!(NorFlash::erase(&mut chip, 4, 0x4000), unaligned);
    assert_eq!(chip.steps(), 0);
}
