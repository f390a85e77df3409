//! The power fails again while the store recovers from the first cut and saves.

use robot_plant::flash_chip::{FlashChip, Phase};

use crate::{
    bench::{Ledger, Tally, boot, tidy},
    first_cut::recover_and_continue,
    workload::{Moment, moments, nth_save},
};

/// Limit of steps, more than an append takes.
const MANY_STEPS: u64 = 40;

/// The second cuts that are tried. The first cuts always include a change of sector.
struct Sample {
    /// One in this many of the saves that only append is cut.
    appends: usize,
    /// Distance between the steps of the recovery that are cut; the first one differs after each first cut.
    stride: u64,
}

#[test]
fn a_cut_in_the_recovery_from_a_cut_loses_nothing() {
    let sample = Sample {
        appends: 8,
        stride: 3,
    };
    let cuts = cut_twice(&sample, "a second cut, sampled");
    assert!(cuts > 5_000);
}

#[test]
#[ignore = "takes half a minute"]
fn a_cut_at_every_step_of_every_recovery_loses_nothing() {
    let all = Sample {
        appends: 1,
        stride: 1,
    };
    cut_twice(&all, "a second cut at every step");
}

fn cut_twice(sample: &Sample, name: &str) -> u32 {
    let mut tally = Tally::default();
    for (number, moment) in moments().iter().enumerate() {
        let changes_sector = moment.steps.end - moment.steps.start > MANY_STEPS;
        if !changes_sector && number % sample.appends != 0 {
            continue;
        }
        for step in moment.steps.clone() {
            let (chip, ledger) = after_first_cut(moment, step);
            cut_again(&chip, &ledger, step, sample.stride, &mut tally);
        }
    }
    tally.assert_none_lost(name);
    tally.cuts
}

fn after_first_cut(moment: &Moment, step: u64) -> (FlashChip, Ledger) {
    let mut chip = moment.chip.clone();
    chip.reseed(step);
    chip.cut_at(step, Phase::Middle);
    let ledger = moment.run(&mut chip);
    chip.power_up();
    (chip, ledger)
}

fn cut_again(chip: &FlashChip, ledger: &Ledger, step: u64, stride: u64, tally: &mut Tally) {
    let mut whole = chip.clone();
    recover(&mut whole, ledger.clone(), step);
    let first = chip.steps() + step % stride;
    for second in (first..whole.steps()).step_by(stride as usize) {
        let phase = if second % 4 == 0 {
            Phase::After
        } else {
            Phase::Middle
        };
        let case = format!("step {step} Middle, then {second} {phase:?}");
        let mut chip = chip.clone();
        chip.cut_at(second, phase);
        let ledger = recover(&mut chip, ledger.clone(), step);
        tally.cuts += 1;
        chip.power_up();
        recover_and_continue(chip, ledger, second as usize, tally, &case);
    }
}

/// Runs a boot, the store's clean-up and a save, until the end or the cut.
fn recover(chip: &mut FlashChip, mut ledger: Ledger, step: u64) -> Ledger {
    let record = nth_save(2_000_000 + step as usize);
    if let Ok((mut store, found)) = boot(chip) {
        ledger.settle(&found);
        // A power cut ends the work at that point.
        if tidy(&mut store).is_ok() && ledger.save(&mut store, &record).is_ok() {
            let _ = tidy(&mut store);
        }
    }
    ledger
}
