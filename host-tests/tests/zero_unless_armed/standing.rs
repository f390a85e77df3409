//! A robot that lies has torque only on the pilot's request, for no longer and with no more than standing up allows.

use robot_app::{
    control::{ChassisControllerInput, ChassisControllerOutput},
    domain::{BalanceState, BalanceStatus, DriveMode, StandSwitch},
};

use super::*;
use crate::{controllers::Rogue, phase::Pc};

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

/// The layout allows 15 A, which are 12,288 counts, and the setting 8 A.
#[test]
fn only_a_robot_that_balances_gets_more_current_than_its_setting() {
    for (state, stand, limit) in [
        (BalanceState::Sit, StandSwitch::Down, LIMIT_COUNTS - 1),
        (BalanceState::Balance, StandSwitch::Up, 12_288),
    ] {
        let mut bench = Bench::new(Make::Dm4310, rogue(state));
        // It may have more than an untuned robot that sits.
        bench.tuned = true;
        let pilot = |ticks, enabled, stand| Phase {
            stand,
            ..good(ticks, enabled)
        };
        bench.run(&[
            pilot(1_000, false, StandSwitch::Down),
            pilot(100, false, stand),
            pilot(500, true, stand),
        ]);
        assert_eq!(bench.ticks.last().map(|tick| tick.wheels[0]), Some(limit));
    }
}

/// Stands while it is asked to and may, with 1 A and another at full stick.
struct Obedient;

impl ChassisController for Obedient {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        let stands = input.hl_cmd.stand && input.stand.permits();
        let (current_ma, state) = if stands {
            (1_000.0 * (1.0 + input.hl_cmd.vx), BalanceState::Balance)
        } else {
            (0.0, BalanceState::Sit)
        };
        Rogue {
            current_ma,
            ..rogue(state)
        }
        .step(input)
    }

    fn reset(&mut self) {}
}

/// 1 A is 819 counts. The sticks do not take the place of the PC.
#[test]
fn a_robot_whose_pc_is_lost_stands_on_the_spot() {
    let mut bench = Bench::new(Make::Dm4310, Obedient);
    let without_pc = |ticks, enabled, stand, vx| Phase {
        stand,
        mode: DriveMode::Pc,
        pc: Pc::Silent,
        sticks: (vx, 0.0),
        ..good(ticks, enabled)
    };
    bench.run(&[
        without_pc(1_000, false, StandSwitch::Down, 0.0),
        without_pc(100, false, StandSwitch::Up, 0.0),
        without_pc(200, true, StandSwitch::Up, 0.0),
    ]);
    let counts = |bench: &Bench<Obedient>| bench.ticks.last().map(|tick| tick.wheels[0]);
    assert_eq!(counts(&bench), Some(819));
    bench.run(&[without_pc(200, true, StandSwitch::Up, 1.0)]);
    assert_eq!(counts(&bench), Some(819));
    bench.run(&[without_pc(200, true, StandSwitch::Down, 0.0)]);
    assert_eq!(counts(&bench), Some(0));
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
