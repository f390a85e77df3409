//! Pages of the firmware, the board, arming and safety.

use super::*;
use crate::{diagnostics::BusUnknownFrames, domain::BusHealth};

pub const VERSION: [LiveField; 4] = [
    count!("major", "", 8, |_, _| number(env!(
        "CARGO_PKG_VERSION_MAJOR"
    ))),
    count!("minor", "", 8, |_, _| number(env!(
        "CARGO_PKG_VERSION_MINOR"
    ))),
    count!("patch", "", 8, |_, _| number(env!(
        "CARGO_PKG_VERSION_PATCH"
    ))),
    choice!("joint-motors", 4, &["mixed", "dm4310", "rs00"], make_of_all),
];

pub const RUN: [LiveField; 2] = [
    count!("uptime-s", "s", 32, |live, _| {
        u32::try_from(live.diagnostics.ts_us / 1_000_000).unwrap_or(u32::MAX)
    }),
    count!("missed-ticks", "", 16, |live, _| live
        .diagnostics
        .tick
        .missed),
];

pub const BOOT: [LiveField; 5] = [
    choice!(
        "reset-cause",
        4,
        &RESET_CAUSES,
        |live, _| live.diagnostics.reset_cause as u32
    ),
    choice!(
        "last-words",
        8,
        &LAST_WORDS,
        |live, _| live.diagnostics.last_words as u32
    ),
    count!("max-jitter-us", "us", 12, |live, _| live
        .diagnostics
        .tick
        .max_jitter_us),
    count!("stalls", "", 8, |live, _| live.diagnostics.tick.stalls),
    count!("longest-stall-ms", "ms", 10, |live, _| live
        .diagnostics
        .tick
        .longest_stall_us
        / 1_000),
];

pub const ARMING: [LiveField; 3] = [
    set!("blockers", 32, ArmingBlockers::name_of_bit, |live, _| live
        .diagnostics
        .arming
        .blockers
        .bits()),
    choice!(
        "state",
        2,
        &["disarmed", "armed"],
        |live, _| live.diagnostics.arming.state as u32
    ),
    set!("debugger", 2, |bit| named(&DEBUGGER, bit), |live, _| {
        let probe = &live.diagnostics.debug_probe;
        marks([probe.attached, probe.catches])
    }),
];

/// Why the last request to arm was refused.
pub const REFUSED: [LiveField; 2] = [
    set!("blockers", 32, ArmingBlockers::name_of_bit, |live, _| live
        .diagnostics
        .arming
        .refused
        .bits()),
    set!("marks", 1, |bit| named(&["waiting"], bit), |live, _| {
        marks([live.diagnostics.arming.waiting])
    }),
];

/// Frames with unknown identifiers; the identifiers are 0 before the first one.
pub const STRANGERS: [LiveField; 3] = [
    count!("frames", "", 16, |live, bus| unknown_frames(live, bus)
        .frames),
    count!("last-id", "", 12, |live, bus| unknown_frames(live, bus)
        .last_id
        .into()),
    count!("esc-id", "", 12, |live, bus| unknown_frames(live, bus)
        .esc_id
        .into()),
];

pub const SAFETY: [LiveField; 3] = [
    set!("flags", 32, SafetyFlags::name_of_bit, |live, _| live
        .diagnostics
        .safety
        .flags
        .bits()),
    choice!(
        "verdict",
        2,
        &["run", "partial-stop", "global-stop"],
        |live, _| live.diagnostics.safety.verdict as u32
    ),
    set!("stopped", 4, |bit| named(&STOPPED, bit), |live, _| {
        let safety = &live.diagnostics.safety;
        let [can1, can2] = safety.bus_stop;
        marks([safety.wheels_stop, safety.joints_stop, can1, can2])
    }),
];

pub const LATCHED: [LiveField; 1] = [set!("flags", 32, SafetyFlags::name_of_bit, |live, _| live
    .diagnostics
    .safety
    .latched
    .bits())];

pub const SEEN: [LiveField; 1] = [set!("flags", 32, SafetyFlags::name_of_bit, |live, _| live
    .diagnostics
    .safety
    .flags_seen
    .bits())];

pub const POWER: [LiveField; 1] = [measure!("battery-v", "V", 16, 500, |live, _| {
    match live.diagnostics.battery_v {
        0.0 => f32::NAN,
        measured => measured,
    }
})];

/// State of the parameter sectors as found at boot.
pub const STORE: [LiveField; 3] = [
    count!("lost-sectors", "", 4, |live, _| live
        .diagnostics
        .params
        .lost_sectors
        .into()),
    count!("strange-sectors", "", 4, |live, _| live
        .diagnostics
        .params
        .strange_sectors
        .into()),
    count!("generation", "", 32, |live, _| live
        .diagnostics
        .params
        .generation),
];

/// Jitter by the core's cycle counter, 168 counts per µs.
pub const TICK: [LiveField; 2] = [
    count!("max-jitter-cycles", "", 24, |live, _| live
        .diagnostics
        .tick
        .max_jitter_cycles),
    count!("period-us", "us", 16, |live, _| live.diagnostics.tick.dt_us),
];

pub const CAN: [LiveField; 6] = [
    choice!(
        "state",
        2,
        &["active", "passive", "bus-off"],
        |live, bus| { health(live, bus).state as u32 }
    ),
    count!("transmit-errors", "", 8, |live, bus| health(live, bus)
        .transmit_errors
        .into()),
    count!("receive-errors", "", 8, |live, bus| health(live, bus)
        .receive_errors
        .into()),
    count!("bus-offs", "", 8, |live, bus| health(live, bus)
        .bus_off_count),
    count!("taken-back", "", 12, |live, bus| health(live, bus)
        .tx_aborted),
    count!("lost", "", 10, |live, bus| {
        let health = health(live, bus);
        health.rx_overruns.saturating_add(health.rx_queue_full)
    }),
];

pub const CAN_FRAMES: [LiveField; 2] = [
    count!("received", "", 32, |live, bus| health(live, bus).rx_frames),
    count!("failures-in-row", "", 16, |live, bus| health(live, bus)
        .tx_failures_in_row),
];

pub(super) const RESET_CAUSES: [&str; 8] = [
    "unknown",
    "power-on",
    "reset-pin",
    "brown-out",
    "software",
    "watchdog",
    "window-watchdog",
    "low-power",
];

/// The texts of `CrashCause::text`.
pub(super) const LAST_WORDS: [&str; 12] = [
    "nothing was reported",
    "panic",
    "hard fault",
    "unexpected interrupt",
    "task imu was late",
    "task mag was late",
    "task sbus was late",
    "task logic was late",
    "task status was late",
    "task params was late",
    "task link-receive was late",
    "task link-send was late",
];

const DEBUGGER: [&str; 2] = ["attached", "catches"];
const STOPPED: [&str; 4] = ["wheels", "joints", "can1", "can2"];

/// `bus` is a valid index.
fn health<'a>(live: &LiveSource<'a>, bus: usize) -> &'a BusHealth {
    let [first, second] = &live.diagnostics.can;
    if bus == 0 { first } else { second }
}

/// The make of all joint motors by its number in stored settings; 0 if they differ.
fn make_of_all(live: &LiveSource<'_>, _: usize) -> u32 {
    let mut makes = live.layout.joints().iter().map(|slot| slot.motor.make());
    let first = makes.next().unwrap_or(0);
    if makes.all(|make| make == first) {
        first.into()
    } else {
        0
    }
}

/// Parses decimal digits up to the first other character.
fn number(text: &str) -> u32 {
    let digits = text.bytes().map_while(|byte| char::from(byte).to_digit(10));
    digits.fold(0, |sum: u32, digit| {
        sum.wrapping_mul(10).wrapping_add(digit)
    })
}

fn unknown_frames(live: &LiveSource<'_>, bus: usize) -> BusUnknownFrames {
    let buses = &live.diagnostics.strangers.buses;
    buses.get(bus).copied().unwrap_or_default()
}
