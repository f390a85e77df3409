//! A robot that lies has torque only on the pilot's request, for no longer and with no more than standing up allows.

use robot_app::domain::{BalanceState, BalanceStatus, StandSwitch};

use super::*;
use crate::controllers::Rogue;

/// The time of standing up, and a tick in which the request takes effect.
const TIME_TICKS: usize = 3_001;
/// 8,000 mA of 20,000 mA, which are 16,384 counts.
const STAND_UP_COUNTS: i32 = 6_554;

/// Lies on its left side, and the estimate knows it.
fn lying(ticks: u16, enabled: bool, stand: StandSwitch) -> Phase {
    Phase {
        accel: [0.0, 9.81, 0.0],
        stand,
        ..good(ticks, enabled)
    }
}

fn rogue(state: BalanceState) -> Rogue {
    Rogue {
        balance: BalanceStatus {
            state,
            ..BalanceStatus::SIT
        },
        ..Rogue::wheels(f32::INFINITY)
    }
}

/// Ticks of the left wheel's current in C620 counts, after the estimate has settled.
fn drive_after_settling(state: BalanceState, phases: &[Phase]) -> Vec<i32> {
    let settle = [lying(3_000, false, StandSwitch::Unknown)];
    let mut bench = Bench::new(Make::Dm4310, rogue(state));
    bench.run(&[&settle, phases].concat());
    let ticks = bench.ticks.iter().skip(3_000);
    ticks.map(|tick| tick.wheels[0]).collect()
}

#[test]
fn a_lying_robot_stands_up_on_request_for_three_seconds() {
    let counts = drive_after_settling(
        BalanceState::StandUp,
        &[
            lying(100, false, StandSwitch::Down),
            lying(100, false, StandSwitch::Up),
            lying(4_000, true, StandSwitch::Up),
        ],
    );
    let driven = counts.iter().filter(|counts| **counts != 0).count();
    assert!((TIME_TICKS - 10..=TIME_TICKS).contains(&driven), "{driven}");
    assert!(counts[..200].iter().all(|counts| *counts == 0));
    assert!(counts.iter().all(|counts| counts.abs() <= STAND_UP_COUNTS));
    assert_eq!(counts.last(), Some(&0));
}

/// What the pilot does in a phase.
fn pilot() -> impl Strategy<Value = Phase> {
    let stand = prop_oneof![
        1 => Just(StandSwitch::Unknown),
        3 => Just(StandSwitch::Down),
        4 => Just(StandSwitch::Up),
    ];
    let rarely = || prop_oneof![14 => Just(false), 1 => Just(true)];
    let others = (rarely(), rarely(), rarely(), rarely());
    (1u16..1_000, any::<bool>(), stand, others).prop_map(|(ticks, enabled, stand, others)| {
        let (e_stop, failsafe, silent, late_task) = others;
        Phase {
            e_stop,
            failsafe,
            radio_sends: !silent,
            late_task,
            ..lying(ticks, enabled, stand)
        }
    })
}

fn state() -> impl Strategy<Value = BalanceState> {
    prop_oneof![
        Just(BalanceState::Sit),
        Just(BalanceState::StandUp),
        Just(BalanceState::Balance),
        Just(BalanceState::SitDown),
    ]
}

/// In each tick, from what the pilot does alone: whether a lying robot may have torque.
fn may_move(phases: &[Phase]) -> Vec<bool> {
    let (mut seen_down, mut up_ticks, mut silent_ticks) = (false, 0, 0);
    let mut heard = &lying(1, false, StandSwitch::Unknown);
    let mut allowed = Vec::new();
    for phase in phases {
        for tick in 0..phase.ticks {
            silent_ticks += 1;
            if phase.radio_sends && tick % 7 == 0 {
                (heard, silent_ticks) = (phase, 0);
            }
            let stopped = heard.e_stop || heard.failsafe || phase.late_task || silent_ticks > 100;
            seen_down = !stopped && (seen_down || heard.stand == StandSwitch::Down);
            let up = heard.stand == StandSwitch::Up && heard.enabled && !stopped;
            up_ticks = if up { up_ticks + 1 } else { 0 };
            allowed.push(seen_down && up && up_ticks <= TIME_TICKS + 1);
        }
    }
    allowed
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_stream_of_switches_moves_a_lying_robot_unasked(
        phases in prop::collection::vec(pilot(), 1..14),
        state in state(),
    ) {
        let counts = drive_after_settling(state, &phases);
        for (tick, (counts, allowed)) in counts.iter().zip(may_move(&phases)).enumerate() {
            prop_assert!(*counts == 0 || allowed, "tick {tick}");
            prop_assert!(counts.abs() <= STAND_UP_COUNTS);
        }
    }
}
