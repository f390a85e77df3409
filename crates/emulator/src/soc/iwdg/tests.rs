//! Times from RM0090 table 107 (LSI at 32 kHz) and the update delay of PR and RLR.

use super::Iwdg;
use crate::{
    soc::test_bench::Bench,
    time::{MS, US},
};

const KR: u32 = 0;
const PR: u32 = 4;
const RLR: u32 = 8;
const SR: u32 = 12;

fn with_lsi() -> (Bench, Iwdg) {
    let mut bench = Bench::new();
    bench.clocks.lsi_on = true;
    (bench, Iwdg::new())
}

#[test]
fn the_shortest_and_longest_times_of_the_table() {
    // Prescaler /4: RLR 0 = 0.125 ms, RLR 0xFFF = 512 ms; /256: 0xFFF = 32768 ms.
    for (pr, rlr, time) in [
        (0, 0, 125 * US),
        (0, 0xFFF, 512 * MS),
        (6, 0xFFF, 32_768 * MS),
    ] {
        let (mut bench, mut iwdg) = with_lsi();
        bench.write(&mut iwdg, KR, 0x5555);
        bench.write(&mut iwdg, PR, pr);
        bench.write(&mut iwdg, RLR, rlr);
        assert_eq!(bench.read(&mut iwdg, SR), 3);
        // Five cycles of the divided clock: 0.625 ms at /4, 40 ms at /256.
        bench.run(&mut iwdg, if pr == 0 { 626 * US } else { 40 * MS + US });
        assert_eq!(bench.read(&mut iwdg, SR), 0);
        bench.write(&mut iwdg, KR, 0xCCCC);
        bench.write(&mut iwdg, KR, 0xAAAA);
        let start = bench.now;
        // Only the watchdog's own events are needed, not the board.
        while bench.scheduler.next() < start + time {
            step(&mut bench, &mut iwdg);
        }
        assert!(!iwdg.take_reset_request());
        step(&mut bench, &mut iwdg);
        // At the start the counter ran from 0xFFF, so the event of that first period may come before.
        while !iwdg.take_reset_request() {
            step(&mut bench, &mut iwdg);
        }
        assert_eq!(bench.now, start + time);
    }
}

fn step(bench: &mut Bench, iwdg: &mut Iwdg) {
    use crate::soc::peripheral::Peripheral;
    let event = bench
        .scheduler
        .pop_due(u64::MAX)
        .expect("a running watchdog");
    bench.now = event.at;
    iwdg.event(event.tag, &mut bench.ctx());
}

#[test]
fn reloading_in_time_keeps_it_quiet() {
    let (mut bench, mut iwdg) = with_lsi();
    bench.write(&mut iwdg, KR, 0x5555);
    // 144 periods of 125 µs: 18 ms.
    bench.write(&mut iwdg, RLR, 143);
    bench.write(&mut iwdg, KR, 0xCCCC);
    for _ in 0..20 {
        let until = bench.now + 17 * MS;
        bench.run(&mut iwdg, until);
        bench.write(&mut iwdg, KR, 0xAAAA);
        assert!(!iwdg.take_reset_request());
    }
    let until = bench.now + 18 * MS;
    bench.run(&mut iwdg, until);
    assert!(iwdg.take_reset_request());
}

#[test]
fn without_the_lsi_an_update_waits_for_the_start() {
    let (mut bench, mut iwdg) = (Bench::new(), Iwdg::new());
    bench.write(&mut iwdg, KR, 0x5555);
    bench.write(&mut iwdg, RLR, 143);
    bench.run(&mut iwdg, 100 * MS);
    // RVU.
    assert_eq!(bench.read(&mut iwdg, SR), 2);
    bench.write(&mut iwdg, KR, 0xCCCC);
    // Five cycles of 125 µs.
    bench.run(&mut iwdg, 100 * MS + 624 * US);
    assert_eq!(bench.read(&mut iwdg, SR), 2);
    bench.run(&mut iwdg, 100 * MS + 626 * US);
    assert_eq!(bench.read(&mut iwdg, SR), 0);
}

#[test]
fn registers_are_locked_without_the_key() {
    let (mut bench, mut iwdg) = (Bench::new(), Iwdg::new());
    bench.write(&mut iwdg, RLR, 1);
    assert_eq!(bench.read(&mut iwdg, RLR), 0xFFF);
    assert!(bench.error_texts()[0].starts_with("IWDG: RLR"));
}

/// A watchdog of 18 ms that runs since 1 ms.
fn running() -> (Bench, Iwdg) {
    let (mut bench, mut iwdg) = with_lsi();
    bench.write(&mut iwdg, KR, 0x5555);
    bench.write(&mut iwdg, RLR, 143);
    bench.run(&mut iwdg, MS);
    bench.write(&mut iwdg, KR, 0xCCCC);
    bench.write(&mut iwdg, KR, 0xAAAA);
    (bench, iwdg)
}

#[test]
fn a_running_watchdog_is_lengthened_by_pr_rlr_and_a_reload() {
    let (mut bench, mut iwdg) = running();
    bench.write(&mut iwdg, KR, 0x5555);
    bench.write(&mut iwdg, PR, 4);
    bench.write(&mut iwdg, RLR, 999);
    assert_eq!(bench.read(&mut iwdg, SR), 3, "PVU and RVU");
    // At /64 a cycle is 2 ms.
    bench.run(&mut iwdg, MS + 9_999 * US);
    assert_eq!(bench.read(&mut iwdg, SR), 3);
    bench.run(&mut iwdg, 12 * MS);
    assert_eq!(bench.read(&mut iwdg, SR), 0);
    bench.write(&mut iwdg, KR, 0xAAAA);
    // 1,000 periods of 64 LSI cycles: 2 s.
    bench.run(&mut iwdg, 12 * MS + 1_999 * MS);
    assert!(!iwdg.take_reset_request());
    bench.run(&mut iwdg, 12 * MS + 2_000 * MS);
    assert!(iwdg.take_reset_request());
}

#[test]
fn a_new_reload_value_counts_from_the_next_reload_only() {
    let (mut bench, mut iwdg) = running();
    bench.write(&mut iwdg, KR, 0x5555);
    bench.write(&mut iwdg, RLR, 0xFFF);
    bench.run(&mut iwdg, MS + 18 * MS);
    assert!(iwdg.take_reset_request());
}

#[test]
fn a_new_divider_counts_from_its_crossing_on() {
    let (mut bench, mut iwdg) = running();
    bench.write(&mut iwdg, KR, 0x5555);
    bench.write(&mut iwdg, PR, 1);
    // Ten of 144 periods are over when PR has crossed after five cycles of 250 µs; the others take 250 µs each.
    let end = MS + 10 * 125 * US + 134 * 250 * US;
    bench.run(&mut iwdg, end - US);
    assert!(!iwdg.take_reset_request());
    bench.run(&mut iwdg, end + US);
    assert!(iwdg.take_reset_request());
}

/// DBG_IWDG_STOP while the core is halted (RM0090 38.16.4).
#[test]
fn a_frozen_counter_goes_on_from_where_it_stood() {
    let (mut bench, mut iwdg) = running();
    let start = bench.now;
    bench.run(&mut iwdg, start + 10 * MS);
    iwdg.freeze(true, &mut bench.ctx());
    bench.run(&mut iwdg, start + 110 * MS);
    assert!(!iwdg.take_reset_request());
    iwdg.freeze(false, &mut bench.ctx());
    bench.run(&mut iwdg, start + 117 * MS);
    assert!(!iwdg.take_reset_request());
    bench.run(&mut iwdg, start + 119 * MS);
    assert!(iwdg.take_reset_request());
}
