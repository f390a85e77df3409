//! The number of saves that the flash endures: 10,000 erases a sector (STM32F407 datasheet, table 42).

use robot_plant::flash_chip::{FlashChip, PARAMETER_SECTORS};

use crate::bench::{new_chip, record, save, tidy};
use robot_app::params::{Record, Store};

/// The groups of settings there are.
const GROUPS: u32 = 11;
const SLOTS: u32 = 127;
const ENDURANCE: u32 = 10_000;

fn erases(chip: &FlashChip) -> [u32; 3] {
    let mut sectors = PARAMETER_SECTORS;
    [(); 3].map(|()| chip.erases(sectors.next().expect("three sectors")))
}

fn change(count: u32) -> Record {
    let key = (count % GROUPS) as u8;
    record(key, 0, 1, &[count; 8])
}

fn save_many(chip: &mut FlashChip, saves: std::ops::Range<u32>) {
    let mut store = Store::open(chip);
    for count in saves {
        save(&mut store, &change(count)).expect("a good chip");
        tidy(&mut store).expect("a good chip");
    }
}

/// A sector takes 127 records, of which 11 were moved there. Whenever a session of a thousand changes begins.
#[test]
fn a_thousand_changes_cost_nine_erases_at_most() {
    let mut chip = new_chip(1);
    let mut after = Vec::new();
    for count in 0..1500 {
        save_many(&mut chip, count..count + 1);
        after.push(erases(&chip).iter().sum::<u32>());
    }
    let costs = after.iter().zip(&after[1000..]);
    let worst = costs.map(|(before, after)| after - before).max();
    let worst = worst.expect("500 sessions");
    println!("1,000 saves: {worst} erases at most");
    assert_eq!(worst, 1000_u32.div_ceil(SLOTS - GROUPS));
}

/// No sector is spared at the cost of another, and the count fits the computed life of the store.
#[test]
fn wear_is_spread_over_the_three_sectors() {
    const SAVES: u32 = 20_000;
    let mut chip = new_chip(1);
    save_many(&mut chip, 0..SAVES);
    let erases = erases(&chip);
    let worst = *erases.iter().max().expect("three sectors");
    let best = *erases.iter().min().expect("three sectors");
    assert!(worst - best <= 1, "{erases:?}");
    let computed = 3 * ENDURANCE * (SLOTS - GROUPS);
    let measured = SAVES / worst * ENDURANCE;
    println!(
        "{SAVES} saves: {erases:?} erases; {ENDURANCE} of a sector last for {computed} saves computed, \
         {measured} measured"
    );
    assert!(
        measured.abs_diff(computed) < computed / 50,
        "{measured} {computed}"
    );
}
