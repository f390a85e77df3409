//! The flash against RM0090 3.6 (sequences, errors), the datasheet's times and docs/hardware.md#flash.

use super::{history::FlashStats, *};
use crate::{
    soc::test_bench::Bench,
    time::{MS, US},
};

const ACR: u32 = 0x00;
const KEYR: u32 = 0x04;
const SR: u32 = 0x0C;
const CR: u32 = 0x10;
const PSIZE_X16: u32 = 1 << 8;
const PSIZE_X32: u32 = 2 << 8;
const ERASE_SECTOR_1: u32 = 1 << 3 | 1 << 1;
const PROGRAM: u32 = PSIZE_X32 | 1;
const STRT: u32 = 1 << 16;
const BSY: u32 = 1 << 16;
/// First word of sector 1.
const WORD: u32 = 0x0800_4000;
const CACHES_ON: u32 = 0x605;
const DATA_CACHE_OFF: u32 = 0x205;
const DATA_CACHE_RESET: u32 = 0x1205;

fn unlocked() -> (Bench, Flash) {
    let (mut bench, mut flash) = (Bench::new(), Flash::default());
    bench.write(&mut flash, ACR, 5);
    bench.write(&mut flash, KEYR, 0x4567_0123);
    bench.write(&mut flash, KEYR, 0xCDEF_89AB);
    (bench, flash)
}

fn store(bench: &mut Bench, flash: &mut Flash, address: u32, word: u32) {
    flash.store(address, 4, word, &mut bench.ctx());
}

/// Waits until the operation ends. Returns how long that took.
fn wait(bench: &mut Bench, flash: &mut Flash) -> Ps {
    let from = bench.now;
    let until = flash.stalled_until().expect("work under way");
    bench.run(flash, until);
    assert_eq!(flash.stalled_until(), None);
    until - from
}

fn program(bench: &mut Bench, flash: &mut Flash, address: u32, word: u32) -> Ps {
    bench.write(flash, CR, PROGRAM);
    store(bench, flash, address, word);
    wait(bench, flash)
}

fn erase_sector_1(bench: &mut Bench, flash: &mut Flash) -> Ps {
    bench.write(flash, CR, PSIZE_X32 | ERASE_SECTOR_1);
    bench.write(flash, CR, PSIZE_X32 | ERASE_SECTOR_1 | STRT);
    wait(bench, flash)
}

#[test]
fn a_word_is_programmed_in_16_us_and_clears_bits_only() {
    let (mut bench, mut flash) = unlocked();
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0xFFFF_FFFF);
    assert_eq!(program(&mut bench, &mut flash, WORD, 0x1234_FF00), 16 * US);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0x1234_FF00);
    assert_eq!(
        (
            flash.load(WORD + 1, 1, &mut bench.ctx()),
            flash.load(WORD + 2, 2, &mut bench.ctx())
        ),
        (0xFF, 0x1234)
    );
    program(&mut bench, &mut flash, WORD, 0x00FF_FFFF);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0x0034_FF00);
    flash.set_times(FlashTimes::Max);
    assert_eq!(program(&mut bench, &mut flash, WORD + 4, 0), 100 * US);
    assert!(bench.error_texts().is_empty());
}

#[test]
fn an_erase_takes_what_the_parallelism_says() {
    for (times, psize, time) in [
        (FlashTimes::Typical, 0, 400 * MS),
        (FlashTimes::Typical, PSIZE_X16, 300 * MS),
        (FlashTimes::Typical, PSIZE_X32, 250 * MS),
        (FlashTimes::Max, 0, 800 * MS),
        (FlashTimes::Max, PSIZE_X16, 600 * MS),
        (FlashTimes::Max, PSIZE_X32, 500 * MS),
    ] {
        let (mut bench, mut flash) = unlocked();
        program(&mut bench, &mut flash, WORD, 0);
        program(&mut bench, &mut flash, WORD + 0x4000, 0);
        flash.set_times(times);
        bench.write(&mut flash, CR, psize | ERASE_SECTOR_1);
        assert_eq!(flash.stalled_until(), None, "not started");
        bench.write(&mut flash, CR, psize | ERASE_SECTOR_1 | STRT);
        assert_eq!(bench.read(&mut flash, SR), BSY);
        assert_eq!(bench.read(&mut flash, CR), psize | ERASE_SECTOR_1 | STRT);
        assert_eq!(wait(&mut bench, &mut flash), time);
        assert_eq!(bench.read(&mut flash, SR), 0);
        assert_eq!(bench.read(&mut flash, CR), psize | ERASE_SECTOR_1);
        assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0xFFFF_FFFF);
        assert_eq!(
            flash.load(WORD + 0x4000, 4, &mut bench.ctx()),
            0,
            "sector 2"
        );
        assert_eq!(bench.board.cells.erases[0], 1);
    }
}

#[test]
fn steps_are_listed_and_survive_a_reset_with_the_contents() {
    let (mut bench, mut flash) = unlocked();
    erase_sector_1(&mut bench, &mut flash);
    program(&mut bench, &mut flash, WORD + 8, 7);
    flash.reset(&mut bench.ctx());
    let counted = FlashStats {
        erases: 1,
        programs: 1,
        longest_stall: 250 * MS,
    };
    assert_eq!(flash.history().stats(), counted);
    let step = |at, kind, address| FlashStep { at, kind, address };
    let steps = [
        step(0, FlashStepKind::Erase, WORD),
        step(250 * MS, FlashStepKind::Program, WORD + 8),
    ];
    assert_eq!(flash.history().steps(), steps);
    assert_eq!(flash.load(WORD + 8, 4, &mut bench.ctx()), 7);
    assert_eq!(bench.read(&mut flash, CR), 1 << 31, "locked again");
}

#[test]
fn without_both_keys_in_order_nothing_begins() {
    let (mut bench, mut flash) = (Bench::new(), Flash::default());
    bench.write(&mut flash, ACR, 5);
    bench.write(&mut flash, KEYR, 0xCDEF_89AB);
    bench.write(&mut flash, KEYR, 0x4567_0123);
    bench.write(&mut flash, CR, ERASE_SECTOR_1 | STRT);
    assert_eq!(flash.stalled_until(), None);
    assert_eq!(bench.error_texts().len(), 3, "{:?}", bench.error_texts());
}

#[test]
fn a_wrong_store_sets_its_error_flag_and_changes_nothing() {
    const PGSERR: u32 = 1 << 7;
    const PGPERR: u32 = 1 << 6;
    for (control, size, flag) in [
        (PSIZE_X32, 4, PGSERR),
        (PROGRAM, 2, PGPERR),
        (PROGRAM, 1, PGPERR),
        (1, 4, PGPERR),
        (PSIZE_X16 | 1, 4, PGPERR),
        (3 << 8 | 1, 4, PGPERR),
        (1 << 31 | PROGRAM, 4, PGSERR),
    ] {
        let (mut bench, mut flash) = unlocked();
        bench.write(&mut flash, CR, control);
        flash.store(WORD, size, 0, &mut bench.ctx());
        assert_eq!(flash.stalled_until(), None);
        assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0xFFFF_FFFF);
        assert_eq!(bench.read(&mut flash, SR), flag, "{control:#x}");
        assert_eq!(bench.error_texts().len(), 1);
        bench.write(&mut flash, SR, PGPERR | PGSERR);
        assert_eq!(bench.read(&mut flash, SR), 0, "cleared by writing 1");
    }
    let (mut bench, mut flash) = unlocked();
    bench.write(&mut flash, CR, PSIZE_X16 | 1);
    flash.store(WORD + 2, 2, 0xABCD, &mut bench.ctx());
    assert_eq!(
        flash.load(WORD, 4, &mut bench.ctx()),
        0xABCD_FFFF,
        "two bytes at once"
    );
}

#[test]
fn the_image_cannot_be_erased_under_its_feet() {
    for control in [ERASE_SECTOR_1 & 2, 4 << 3 | 2, 1 << 2] {
        let (mut bench, mut flash) = unlocked();
        let begun = flash.write(CR, 4, control | STRT, &mut bench.ctx());
        assert!(begun.is_err(), "{control:#x}");
    }
}

#[test]
fn the_end_is_shown_and_interrupts_only_if_asked_for() {
    const EOP: u32 = 1;
    let (mut bench, mut flash) = unlocked();
    program(&mut bench, &mut flash, WORD, 0);
    assert_eq!(bench.read(&mut flash, SR), 0);
    bench.write(&mut flash, CR, PROGRAM | 1 << 24);
    store(&mut bench, &mut flash, WORD + 4, 0);
    assert!(!bench.irq.level(4));
    wait(&mut bench, &mut flash);
    assert_eq!(bench.read(&mut flash, SR), EOP);
    assert!(bench.irq.level(4));
    bench.write(&mut flash, SR, EOP);
    assert!(!bench.irq.level(4));
}

#[test]
fn a_second_store_waits_for_the_first() {
    let (mut bench, mut flash) = unlocked();
    bench.write(&mut flash, CR, PROGRAM);
    store(&mut bench, &mut flash, WORD, 1);
    store(&mut bench, &mut flash, WORD + 4, 2);
    assert_eq!(wait(&mut bench, &mut flash), 32 * US);
    assert_eq!(
        (
            flash.load(WORD, 4, &mut bench.ctx()),
            flash.load(WORD + 4, 4, &mut bench.ctx())
        ),
        (1, 2)
    );
}

#[test]
fn the_data_cache_shows_an_erased_sector_as_it_was_until_it_is_reset() {
    let (mut bench, mut flash) = unlocked();
    program(&mut bench, &mut flash, WORD, 5);
    bench.write(&mut flash, ACR, CACHES_ON);
    erase_sector_1(&mut bench, &mut flash);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 5);
    bench.write(&mut flash, ACR, DATA_CACHE_OFF);
    assert_eq!(
        flash.load(WORD, 4, &mut bench.ctx()),
        0xFFFF_FFFF,
        "past the cache"
    );
    bench.write(&mut flash, ACR, CACHES_ON);
    assert_eq!(
        flash.load(WORD, 4, &mut bench.ctx()),
        5,
        "switching it off empties nothing"
    );
    assert!(bench.error_texts().is_empty());
    bench.write(&mut flash, ACR, DATA_CACHE_RESET);
    assert_eq!(bench.error_texts().len(), 1, "reset while still on");
    bench.write(&mut flash, ACR, CACHES_ON);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 5);
    bench.write(&mut flash, ACR, DATA_CACHE_OFF);
    bench.write(&mut flash, ACR, DATA_CACHE_RESET);
    bench.write(&mut flash, ACR, CACHES_ON);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0xFFFF_FFFF);
}

#[test]
fn the_data_cache_shows_the_word_meant_and_not_the_one_the_cells_took() {
    let (mut bench, mut flash) = unlocked();
    program(&mut bench, &mut flash, WORD, 0xF0);
    bench.write(&mut flash, ACR, CACHES_ON);
    program(&mut bench, &mut flash, WORD, 0x0F);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0x0F);
    bench.write(&mut flash, ACR, DATA_CACHE_OFF);
    bench.write(&mut flash, ACR, DATA_CACHE_RESET);
    bench.write(&mut flash, ACR, CACHES_ON);
    assert_eq!(flash.load(WORD, 4, &mut bench.ctx()), 0);
}

#[test]
fn a_power_cut_comes_at_its_step_and_nothing_after_it() {
    // A cut before the step leaves the word blank; a cut after it leaves the whole word.
    for (phase, left) in [(CutPhase::Before, 0xFFFF_FFFF), (CutPhase::After, 2)] {
        let (mut bench, mut flash) = unlocked();
        let cut = PlannedCut {
            step: 1,
            phase,
            seed: 1,
        };
        flash.plan_cut(cut);
        program(&mut bench, &mut flash, WORD, 1);
        assert!(!flash.take_power_failure());
        store(&mut bench, &mut flash, WORD + 4, 2);
        store(&mut bench, &mut flash, WORD + 8, 3);
        if phase == CutPhase::After {
            assert_eq!(wait(&mut bench, &mut flash), 16 * US);
        }
        assert!(flash.take_power_failure());
        flash.reset(&mut bench.ctx());
        let words = [0, 4, 8].map(|offset| flash.load(WORD + offset, 4, &mut bench.ctx()));
        assert_eq!(words, [1, left, 0xFFFF_FFFF], "{phase:?}");
        assert_eq!(flash.history().steps().len(), 2);
    }
}

#[test]
fn in_the_middle_of_an_erase_the_power_goes_half_way_and_leaves_no_clean_sector() {
    // The contents of a torn sector are random, and with some seeds it looks erased.
    let torn = (0..8).filter(|&seed| {
        let (mut bench, mut flash) = unlocked();
        program(&mut bench, &mut flash, WORD, 0);
        let phase = CutPhase::Middle;
        flash.plan_cut(PlannedCut {
            step: 1,
            phase,
            seed,
        });
        bench.write(&mut flash, CR, PSIZE_X32 | ERASE_SECTOR_1 | STRT);
        bench.run_while(&mut flash, 16 * US + 124 * MS, |_| true);
        assert!(!flash.take_power_failure());
        bench.run(&mut flash, 16 * US + 125 * MS);
        assert!(flash.take_power_failure());
        flash.reset(&mut bench.ctx());
        (WORD..WORD + 0x4000)
            .step_by(4)
            .any(|address| flash.load(address, 4, &mut bench.ctx()) != 0xFFFF_FFFF)
    });
    assert!(torn.count() >= 6);
}

#[test]
fn a_reset_tears_what_is_under_way() {
    let (mut bench, mut flash) = unlocked();
    bench.write(&mut flash, CR, PSIZE_X32 | ERASE_SECTOR_1 | STRT);
    bench.run(&mut flash, 100 * MS);
    flash.reset(&mut bench.ctx());
    assert_eq!(flash.stalled_until(), None);
    let changed = |bench: &mut Bench, flash: &mut Flash| {
        (WORD..WORD + 0x4000)
            .step_by(4)
            .filter(|address| flash.load(*address, 4, &mut bench.ctx()) != 0xFFFF_FFFF)
            .count()
    };
    // The sector was blank before, so only the torn erase can have changed it.
    assert!(changed(&mut bench, &mut flash) > 0);
    bench.run(&mut flash, 300 * MS);
    assert!(
        changed(&mut bench, &mut flash) > 0,
        "the erase does not end by itself"
    );
}
