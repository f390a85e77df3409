//! The page of a robot that balances.

use super::*;

/// Length and lean are 0 while the robot sits.
pub const BALANCE: [LiveField; 7] = [
    choice!(
        "state",
        3,
        &[
            "sit",
            "stand-up",
            "balance",
            "jump",
            "sit-down",
            "fallen",
            "cannot-rise"
        ],
        |live, _| live.diagnostics.balance.state as u32
    ),
    choice!(
        "request",
        3,
        &[
            "switch-must-go-down",
            "ready",
            "requested",
            "standing-up",
            "standing"
        ],
        |live, _| live.diagnostics.safety.stand as u32
    ),
    set!("marks", 2, |bit| named(&MARKS, bit), |live, _| {
        let balance = &live.diagnostics.balance;
        marks([balance.airborne, balance.slipping])
    }),
    count!("left-leg-mm", "mm", 9, |live, _| millimetres(live, 0)),
    count!("right-leg-mm", "mm", 9, |live, _| millimetres(live, 1)),
    measure!("left-lean-rad", "rad", 11, 500, |live, _| lean_rad(live, 0)),
    measure!("right-lean-rad", "rad", 11, 500, |live, _| lean_rad(
        live, 1
    )),
];

const MARKS: [&str; 2] = ["airborne", "slipping"];

fn millimetres(live: &LiveSource<'_>, leg: usize) -> u32 {
    let lengths = live.diagnostics.balance.leg_m;
    lengths
        .get(leg)
        .map_or(0, |length| (length * 1_000.0) as u32)
}

fn lean_rad(live: &LiveSource<'_>, leg: usize) -> f32 {
    let leans = live.diagnostics.balance.lean_rad;
    leans.get(leg).copied().unwrap_or(f32::NAN)
}
