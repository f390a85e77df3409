//! Records of another firmware are kept bit for bit.

use robot_app::params::MAX_RECORDS;
use robot_plant::flash_chip::FlashChip;

use crate::bench::{Contents, boot, identity, new_chip, record, save, save_all, tidy};

/// Keys, versions, makes of motors and values no firmware of ours has.
fn foreign() -> Contents {
    let records = [
        record(0, 0, 0, &[]),
        record(4, 0, 200, &[0x7FC0_0001, 0xFFFF_FFFF]),
        record(16, 9, 1, &[0xFF80_0000; 8]),
        record(255, 255, 255, &[0xFFFF_FFFF; 28]),
        record(100, 3, 7, &[0x8000_0000, 0, 0xFFFF_FFFF, 0xFFFF_FFFF]),
    ];
    records.map(|record| (identity(&record), record)).into()
}

fn change_sector(chip: &mut FlashChip, times: u32) {
    let (mut store, _) = boot(chip).expect("a good chip");
    let first = store.report().generation;
    let mut count = 0;
    while store.report().generation < first + times {
        count += 1;
        save(&mut store, &record(1, 0, 1, &[count])).expect("a good chip");
        tidy(&mut store).expect("a good chip");
    }
}

#[test]
fn foreign_records_are_rotated_bit_for_bit() {
    let mut chip = new_chip(3);
    let records: Vec<_> = foreign().into_values().collect();
    save_all(&mut chip, &records);
    change_sector(&mut chip, 4);
    let (_, mut found) = boot(&mut chip).expect("a good chip");
    assert!(found.remove(&(1, 0)).is_some());
    assert_eq!(found, foreign());
}

/// Records of different motor makes differ in the variant alone, and neither overwrites the other.
#[test]
fn variants_of_one_key_are_records_of_their_own() {
    let mut chip = new_chip(4);
    let of_make = |variant| record(16, variant, 1, &[u32::from(variant) * 1000]);
    let wanted = save_all(&mut chip, &[of_make(1), of_make(2), of_make(1)]);
    change_sector(&mut chip, 1);
    let (_, mut found) = boot(&mut chip).expect("a good chip");
    found.remove(&(1, 0));
    assert_eq!(found, wanted);
    assert_eq!(found.len(), 2);
}

#[test]
fn the_promised_number_of_records_is_rotated() {
    let mut chip = new_chip(6);
    let others = 2..MAX_RECORDS as u8 + 1;
    let records: Vec<_> = others.map(|key| record(key, 0, 1, &[key.into()])).collect();
    let wanted = save_all(&mut chip, &records);
    assert_eq!(wanted.len(), MAX_RECORDS - 1);
    change_sector(&mut chip, 2);
    let (_, mut found) = boot(&mut chip).expect("a good chip");
    found.remove(&(1, 0));
    assert_eq!(found, wanted);
}
