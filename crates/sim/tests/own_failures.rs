//! The image fails while it drives: how long until zero torque on both buses, the reset, and zero torque after it.
//!
//! Limits: "panic → zero torque frames ≤ 1 ms; hang → watchdog reset ≤ 60 ms, zero torque ≤ 20 ms after reset". They hold
//! with a debug probe attached, and after one.

mod support;

#[path = "own_failures/reaction.rs"]
mod reaction;

use std::{sync::Mutex, thread};

use reaction::{Debugger, Reaction, reaction};
use robot_plant::time::{MS, Ps};
use robot_sim::machine::faults;

/// Runs all on all cores. Returns the reactions in the order of `runs`.
fn run_all(runs: &[(&'static str, Debugger)]) -> Vec<Reaction> {
    robot_test_support::image();
    let queue = Mutex::new(runs.iter().enumerate());
    let reactions = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(|| {
                while let Some((place, run)) = { queue.lock().unwrap().next() } {
                    let reaction = reaction(run.0, run.1);
                    reactions.lock().unwrap().push((place, reaction));
                }
            });
        }
    });
    let mut reactions = reactions.into_inner().unwrap();
    reactions.sort_by_key(|(place, _)| *place);
    assert_eq!(reactions.len(), runs.len());
    reactions
        .into_iter()
        .map(|(_, reaction)| reaction)
        .collect()
}

fn print(runs: &[(&str, Debugger)], reactions: &[Reaction]) {
    println!("ms to:              zero CAN1  zero CAN2  reset   then zero CAN1  zero CAN2");
    for ((name, _), r) in runs.iter().zip(reactions) {
        let [can1, can2] = r.zero.map(shown);
        let [then1, then2] = r.zero_after_reset.map(shown);
        let reset = shown(Some(r.reset));
        println!("{name:<19} {can1:>9}  {can2:>9}  {reset:>5}   {then1:>14}  {then2:>9}");
    }
}

fn shown(time: Option<Ps>) -> String {
    time.map_or("–".into(), |t| format!("{:.2}", t as f64 / MS as f64))
}

fn must_hold(runs: &[(&str, Debugger)], reactions: &[Reaction]) {
    for ((name, debugger), r) in runs.iter().zip(reactions) {
        assert!(r.resets_to_zero(), "{name}, {debugger:?}: {r:?}");
        if !name.starts_with("task-") {
            assert!(r.is_zero_at_once(), "{name}, {debugger:?}: {r:?}");
        }
    }
}

#[test]
fn every_failure_of_the_image_ends_without_torque() {
    let names = faults::of_the_program().map(|fault| fault.name);
    let runs: Vec<_> = names.map(|name| (name, Debugger::Never)).collect();
    let reactions = run_all(&runs);
    print(&runs, &reactions);
    must_hold(&runs, &reactions);
}

/// One failure of each kind, and a debugger at its most and at its least.
#[test]
fn a_debug_probe_switches_no_safety_off() {
    let failures = [
        "panic",
        "panic-thread",
        "hard-fault",
        "stack-overflow",
        "task-stuck-control",
    ];
    let probes = [Debugger::Attached, Debugger::LeftBehind("probe-attached")];
    let mut runs: Vec<_> = failures
        .into_iter()
        .flat_map(|failure| probes.map(|debugger| (failure, debugger)))
        .collect();
    runs.extend([
        ("hard-fault", Debugger::AttachedWhileArmed),
        ("task-stuck-control", Debugger::AttachedWhileArmed),
        ("panic", Debugger::LeftBehind("probe-breakpoints")),
        ("hard-fault", Debugger::LeftBehind("probe-breakpoints")),
    ]);
    must_hold(&runs, &run_all(&runs));
}
