//! The power fails at every step of the workload: before it, during it and after it.

use robot_plant::flash_chip::{FlashChip, Phase};

use crate::{
    bench::{Contents, Ledger, Tally, boot, new_chip, read},
    workload::{Moment, moments, nth_save},
};
use robot_app::params::Store;

/// The way a word or a sector is torn is random, and differs for each of these seeds.
const SEEDS: u64 = 5;

#[test]
fn after_a_cut_each_record_is_the_old_or_the_new_one() {
    let mut tally = Tally::default();
    for moment in moments() {
        for step in moment.steps.clone() {
            cut(&moment, step, Phase::Before, 0, &mut tally);
            cut(&moment, step, Phase::After, 0, &mut tally);
            for seed in 0..SEEDS {
                cut(&moment, step, Phase::Middle, seed, &mut tally);
            }
        }
    }
    tally.assert_none_lost("one cut");
    assert!(tally.cuts > 10_000);
}

fn cut(moment: &Moment, step: u64, phase: Phase, seed: u64, tally: &mut Tally) {
    let case = format!("step {step}, {phase:?}, seed {seed}");
    let mut chip = moment.chip.clone();
    chip.reseed(step << 16 | seed);
    chip.cut_at(step, phase);
    let ledger = moment.run(&mut chip);
    assert!(!chip.is_powered(), "{case}: the step was never done");
    tally.cuts += 1;
    chip.power_up();
    read_without_recovery(&mut chip, &ledger, tally, &case);
    recover_and_continue(chip, ledger, step as usize, tally, &case);
}

/// A boot that is not allowed to program anything.
fn read_without_recovery(chip: &mut FlashChip, ledger: &Ledger, tally: &mut Tally, case: &str) {
    let mut store = Store::open(chip);
    tally.check_report(&store, case);
    let found = read(&mut store);
    tally.check(ledger, &found, case);
}

/// What the first boot finds stays. The next saves work and stay as well.
pub fn recover_and_continue(
    mut chip: FlashChip,
    mut ledger: Ledger,
    count: usize,
    tally: &mut Tally,
    case: &str,
) {
    let Ok((store, found)) = boot(&mut chip) else {
        tally.failed_saves += 1;
        return;
    };
    tally.check_report(&store, case);
    tally.check(&ledger, &found, case);
    ledger.settle(&found);
    let (mut store, found) = boot(&mut chip).expect("settled");
    tally.check(&ledger, &found, case);
    for count in [count, count + 1] {
        let saved = ledger.save(&mut store, &nth_save(1_000_000 + count));
        tally.check_save(saved, case);
    }
    let (store, found) = boot(&mut chip).expect("settled");
    tally.check_report(&store, case);
    tally.check(&ledger, &found, case);
}

/// The first saves of a new chip have a word of every kind; each is torn in many ways.
#[test]
fn no_torn_word_loses_a_record() {
    const WAYS: u64 = 400;
    let mut tally = Tally::default();
    let mut chip = new_chip(1);
    let mut contents = Contents::new();
    for count in 0..3 {
        let moment = Moment::at(&mut chip, &mut contents, nth_save(count));
        for step in moment.steps.clone() {
            for seed in 0..WAYS {
                cut(&moment, step, Phase::Middle, seed, &mut tally);
            }
        }
    }
    tally.assert_none_lost("one cut in a new store");
}
