//! Expected outcome of every fault, from the rules of docs/safety.md and the devices' datasheets. Nothing here is derived
//! from the firmware's behaviour. Times count from the start of the fault.

use crate::{
    link_rows,
    row::{After, Arms, Flags, Group, Row, flags, global, harmless, row},
};

/// Every row, in the order of the document.
pub fn rows() -> Vec<Row> {
    [
        radio(),
        link_rows::rows(),
        sensors(),
        buses(),
        wheels(),
        joints(),
        power_and_pose(),
        image(),
        supply_and_flash(),
        debug_probe(),
    ]
    .concat()
}

/// A frame every 7 ms takes 3 ms; then 3 ms to zero on both buses (docs/safety.md#reaction-times).
pub const NEXT_FRAME_MS: f64 = 7.0 + 3.0 + 3.0;
/// The last good frame may be 100 ms old, and ended up to 7 ms before the fault or up to 3 ms after its start.
pub const REMOTE_LOST_MS: f64 = 100.0 + 3.0 + 3.0;

/// The faults that a robot that balances meets in every run of the tests.
pub const BALANCING_SAMPLE: [&str; 13] = [
    "e-stop",
    "sbus-silent",
    "link-cut",
    "imu-gone",
    "gyro-fifo-shift",
    "can1-broken",
    "can2-empty",
    "motor-0-gone",
    "motor-1-frozen",
    "motor-4-fault",
    "motor-5-frozen",
    "tilted",
    "hard-fault",
];

fn radio() -> Vec<Row> {
    let lost = flags(&["remote-lost"], &["remote-quality", "remote-failsafe"]);
    let mut rows = vec![
        global("e-stop", NEXT_FRAME_MS, flags(&["e-stop"], &[])),
        global("sbus-silent", REMOTE_LOST_MS, lost.clone()),
        global(
            "sbus-failsafe",
            NEXT_FRAME_MS,
            flags(&["remote-failsafe"], &["remote-lost", "remote-quality"]),
        ),
        global("sbus-frame-lost", REMOTE_LOST_MS, lost),
        global(
            "sbus-noise",
            1_000.0,
            flags(&["remote-quality"], &["remote-lost"]),
        )
        .causing_board_errors(&["USART3"])
        .arms_during(Arms::Either),
    ];
    // Fewer than half of the last 64 frames good: too bad to drive.
    for fault in ["sbus-loss-10", "sbus-loss-20", "sbus-loss-30"] {
        rows.push(harmless(fault, Flags::default()));
    }
    let quality = || flags(&[], &["remote-quality", "remote-lost"]);
    for fault in ["sbus-loss-40", "sbus-loss-50", "sbus-loss-60"] {
        let edge = row(
            fault,
            Group::Either,
            Group::Either,
            quality(),
            After::WhatRan,
        );
        rows.push(edge.arms_during(Arms::Either));
    }
    for fault in ["sbus-loss-70", "sbus-loss-80", "sbus-loss-90"] {
        let bad = global(fault, 1_000.0, quality());
        rows.push(bad.arms_during(Arms::Either));
    }
    rows
}

fn sensors() -> Vec<Row> {
    // Stale is not latched; a sensor that answers nonsense or repeats itself has its samples rejected, and errors that
    // add up are.
    let dead = flags(&["imu-stale"], &["imu-errors", "estimate-invalid"]);
    let wrong = || flags(&["imu-stale", "imu-errors"], &["estimate-invalid", "tilt"]);
    vec![
        // After a gap of two seconds the vertical must be found again, which takes half a second of rest.
        global("imu-gone", 35.0, dead).back_within_ms(1_600.0),
        global("imu-frozen", 100.0, wrong()).latched(),
        global("imu-extreme", 100.0, wrong()).latched(),
        // Wrong frames are known by themselves, or by the data registers.
        harmless("gyro-fifo-shift", Flags::default()),
        harmless("gyro-spike", Flags::default()),
        harmless("mag-gone", flags(&[], &[])),
        harmless("i2c-held", flags(&[], &[])),
    ]
}

/// One bus faulty: its own actuators stop, the others run on.
fn buses() -> Vec<Row> {
    let can1 = |fault, must: &[&'static str], may: &[&'static str]| {
        row(
            fault,
            Group::Unreachable,
            Group::Runs,
            flags(must, may),
            After::Drives,
        )
        .waiting(After::WheelsWait)
    };
    // A DM4310 that receives nothing for 100 ms switches off by itself and reports that until it is cleared.
    let can2 = |fault, must: &[&'static str], may: &[&'static str]| {
        row(
            fault,
            Group::Runs,
            Group::Zero(105.0),
            flags(must, may),
            After::WheelsOnly,
        )
    };
    // A controller that went off its bus tries to come back 1.6 s after the last failure at the latest.
    let slow = |row: Row| row.back_within_ms(1_800.0);
    let wheels_silent = ["wheel-left-silent", "wheel-right-silent"];
    let joints_silent = ["joint-silent", "joint-fault"];
    vec![
        slow(can1(
            "can1-broken",
            &["can1-fault"],
            &[&wheels_silent[..], &["can1-congested"]].concat(),
        )),
        can1("can1-empty", &wheels_silent, &["can1-congested"]),
        can1("rogue-node-can1", &["can1-congested"], &wheels_silent),
        slow(can2(
            "can2-broken",
            &["can2-fault"],
            &[&joints_silent[..], &["can2-congested"]].concat(),
        )),
        can2(
            "can2-empty",
            &["joint-silent"],
            &["can2-congested", "joint-fault"],
        ),
        can2("rogue-node-can2", &["can2-congested"], &joints_silent),
    ]
}

fn wheels() -> Vec<Row> {
    let mut rows = Vec::new();
    let wheels = [
        [
            "motor-0-gone",
            "motor-0-wrong-id",
            "motor-0-doubled",
            "motor-0-frozen",
            "motor-0-hot",
            "wheel-left-silent",
            "wheel-right-silent",
        ],
        [
            "motor-1-gone",
            "motor-1-wrong-id",
            "motor-1-doubled",
            "motor-1-frozen",
            "motor-1-hot",
            "wheel-right-silent",
            "wheel-left-silent",
        ],
    ];
    for (wheel, names) in wheels.into_iter().enumerate() {
        let [gone, wrong_id, doubled, frozen, hot, silent, silent_other] = names;
        // Control of a silent wheel falls back to open loop.
        let received_before = |fault, silent| harmless(fault, flags(&[silent], &[]));
        let lost = |row: Row, wheel, deaf| row.waiting(After::WheelsWait).losing_wheel(wheel, deaf);
        rows.push(lost(received_before(gone, silent), wheel, true));
        rows.push(lost(received_before(wrong_id, silent), wheel, true));
        // The other wheel has this one's number: its own is silent, and this one's reports contradict each other.
        let doubled = lost(received_before(doubled, silent_other), 1 - wheel, false);
        let twice = &["two nodes send identifier"];
        rows.push(doubled.arms_during(Arms::No).causing_board_errors(twice));
        let stopped = row(
            frozen,
            Group::Zero(110.0),
            Group::Runs,
            flags(&["wheel-frozen"], &[]),
            After::JointsOnly,
        );
        rows.push(stopped.unseen_at_rest());
        // The stop is not latched: a motor that has cooled down may continue.
        let stopped = row(
            hot,
            Group::Zero(600.0),
            Group::Runs,
            flags(&["wheel-hot"], &[]),
            After::Drives,
        );
        rows.push(stopped.waiting(After::WheelsWait));
    }
    rows
}

fn joints() -> Vec<Row> {
    let mut rows = Vec::new();
    for [gone, wrong_id, frozen, hot, fault] in [
        [
            "motor-2-gone",
            "motor-2-wrong-id",
            "motor-2-frozen",
            "motor-2-hot",
            "motor-2-fault",
        ],
        [
            "motor-3-gone",
            "motor-3-wrong-id",
            "motor-3-frozen",
            "motor-3-hot",
            "motor-3-fault",
        ],
        [
            "motor-4-gone",
            "motor-4-wrong-id",
            "motor-4-frozen",
            "motor-4-hot",
            "motor-4-fault",
        ],
        [
            "motor-5-gone",
            "motor-5-wrong-id",
            "motor-5-frozen",
            "motor-5-hot",
            "motor-5-fault",
        ],
    ] {
        let joints = |fault, within_ms, flags, after| {
            row(fault, Group::Runs, Group::Zero(within_ms), flags, after)
        };
        let silent = || flags(&["joint-silent"], &["joint-fault"]);
        let waits = |row: Row| row.waiting(After::JointsWait);
        rows.push(waits(joints(gone, 60.0, silent(), After::Drives)));
        rows.push(waits(joints(wrong_id, 110.0, silent(), After::Drives)));
        // A leg at rest legitimately repeats its position.
        rows.push(harmless(frozen, Flags::default()).may_fall(&["joint-frozen"]));
        rows.push(waits(joints(
            hot,
            600.0,
            flags(&["joint-hot"], &[]),
            After::Drives,
        )));
        rows.push(joints(fault, 10.0, flags(&["joint-fault"], &[]), After::WheelsOnly).latched());
    }
    // An armed robot writes no register.
    rows.push(harmless("joint-writes-slow", Flags::default()));
    rows
}

fn power_and_pose() -> Vec<Row> {
    vec![
        harmless("battery-low", flags(&["battery-low"], &[])).arms_during(Arms::No),
        // Empty for 1 s, by the median of the last 100 ms.
        global(
            "battery-empty",
            1_100.0,
            flags(&["battery-low", "battery-empty"], &[]),
        )
        .latched(),
        // The chip's own reference shows the error.
        harmless("vdda-high", Flags::default()),
        harmless("vdda-low", Flags::default()),
        // 0.9 rad at 2 rad/s, and 50 ms to be sure.
        // A hand pushes a standing robot over with its weight, 0.1 m above its centre of mass: without wheels 0.7 rad would
        // come after 0.2 s; its wheels follow the hand for up to 0.13 s longer, then 20 ms to be sure.
        global("tilted", 600.0, flags(&["tilt"], &["estimate-invalid"]))
            .latched()
            .thrown_over(350.0),
        // 3 ms until the gyro shows the end of its range, two samples of 5 ms, 3 ms to zero. At rest again it is valid
        // within 1.5 s, which may be while the body still leans.
        // A standing robot gets 4 m/s at its upper edge, and reaches 0.7 rad within some 50 ms.
        global("blow", 16.0, flags(&["estimate-invalid"], &[]))
            .arms_during(Arms::Either)
            .thrown_over(100.0),
        harmless("floor-slippery", Flags::default()).may_fall(&[]),
    ]
}

/// Nothing is saved while armed, and a robot whose settings cannot be saved still drives.
fn supply_and_flash() -> Vec<Row> {
    // The motors have their own power. A DM4310 that receives nothing for 100 ms switches off by itself. The board boots
    // disarmed, and takes the sensors' calibration and the motors' set-up first.
    let power_cut = row(
        "power-cut",
        Group::Unreachable,
        Group::Zero(105.0),
        Flags::default(),
        After::Off,
    );
    vec![
        power_cut.resetting().back_within_ms(3_000.0),
        harmless("flash-stuck-bits", Flags::default()),
        harmless("flash-erase-fails", Flags::default()),
    ]
}

/// The image undoes what a probe has left, or does not arm. A halt longer than the short watchdog period (18 ms at the
/// nominal 32 kHz) ends in a reset like any other.
fn debug_probe() -> Vec<Row> {
    let insists = harmless("probe-insists", Flags::default());
    let mut rows = vec![
        harmless("probe-attached", Flags::default()),
        insists.arms_during(Arms::No),
        harmless("probe-breakpoints", Flags::default()),
        harmless("probe-halts-5ms", Flags::default()),
    ];
    for fault in ["probe-halts-20ms", "probe-halts-100ms"] {
        let halted = global(fault, 18.0 + 20.0, Flags::default());
        rows.push(halted.resetting().arms_during(Arms::Yes));
    }
    rows
}

/// docs/safety.md#reaction-times: panic 1 ms; hang: reset within 60 ms, zero within 20 ms of it.
fn image() -> Vec<Row> {
    let mut rows = Vec::new();
    for fault in ["panic", "panic-thread", "hard-fault", "stack-overflow"] {
        rows.push(global(fault, 1.0, Flags::default()).resetting());
    }
    let late = || {
        flags(
            &[],
            &[
                "task-late",
                "imu-stale",
                "estimate-invalid",
                "remote-lost",
                "remote-quality",
                "command-stale",
            ],
        )
    };
    for fault in [
        "task-stuck-control",
        "task-stuck-sensor",
        "task-stuck-thread",
        "task-asleep-imu",
        "task-asleep-mag",
        "task-asleep-sbus",
        "task-asleep-logic",
        "task-asleep-status",
        "task-asleep-params",
        "task-asleep-link-receive",
        "task-asleep-link-send",
    ] {
        rows.push(global(fault, 80.0, late()).resetting());
    }
    for row in &mut rows {
        // The new boot has no record of the fault.
        row.disarmed.arms_during = Arms::Yes;
    }
    rows
}
