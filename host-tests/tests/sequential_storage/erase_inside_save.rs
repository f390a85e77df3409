//! The crate erases at any time: inside a save, twice in the save after a cut, and inside a read at boot.

use robot_plant::flash_chip::{FlashChip, Phase};

use crate::{
    flash::erases,
    settings::{Keeper, Save},
    the_crate::SequentialStorage,
};

/// Saves from a blank chip to the first that erases; the chip before it, and that save.
fn first_erasing_save() -> (FlashChip, Save) {
    let mut chip = FlashChip::parameters(0);
    for number in 0.. {
        let before = chip.clone();
        let save = Save::nth(number);
        assert!(SequentialStorage.save(&mut chip, save));
        if erases(&chip) > 0 {
            return (before, save);
        }
    }
    unreachable!("the sectors are full some day");
}

#[test]
fn a_save_erases_without_being_asked() {
    let mut chip = FlashChip::parameters(0);
    let saves = 3_000;
    let (mut erasing, mut most_words) = (0, 0);
    for number in 0..saves {
        let (erased, words) = (erases(&chip), chip.programs());
        assert!(SequentialStorage.save(&mut chip, Save::nth(number)));
        erasing += u32::from(erases(&chip) > erased);
        most_words = most_words.max(chip.programs() - words);
    }
    println!("{erasing} of {saves} saves erase; up to {most_words} words in one save");
    assert!(erasing > 0);
}

#[test]
fn the_save_after_a_cut_may_erase_twice() {
    let (before, save) = first_erasing_save();
    let mut whole = before.clone();
    assert!(SequentialStorage.save(&mut whole, save));
    let most = (before.steps()..whole.steps())
        .map(|step| {
            let mut chip = before.clone();
            chip.cut_at(step, Phase::After);
            assert!(!SequentialStorage.save(&mut chip, save));
            chip.power_up();
            let erased = erases(&chip);
            assert!(SequentialStorage.save(&mut chip, save));
            erases(&chip) - erased
        })
        .max();
    assert_eq!(most, Some(2));
}

#[test]
fn a_boot_may_erase_before_it_has_read_anything() {
    let (before, save) = first_erasing_save();
    let erase_step = (before.steps()..)
        .find(|&step| {
            let mut chip = before.clone();
            chip.cut_at(step, Phase::After);
            assert!(!SequentialStorage.save(&mut chip, save));
            erases(&chip) > 0
        })
        .unwrap();
    let erasing_boots = (0..40)
        .filter(|&seed| {
            let mut chip = before.clone();
            chip.reseed(seed);
            chip.cut_at(erase_step, Phase::Middle);
            assert!(!SequentialStorage.save(&mut chip, save));
            chip.power_up();
            let erased = erases(&chip);
            SequentialStorage.load(&mut chip);
            erases(&chip) > erased
        })
        .count();
    println!("{erasing_boots} of 40 boots after a torn erase erase something");
    assert!(erasing_boots > 0);
}
