//! Requests over CAN: what tuning may change and when, and what bring-up lets through. docs/tuning.md, docs/bring-up.md.

use robot_app::{
    domain::DriveMode,
    tuning::{WRITE_ID, opcode},
};

use super::*;
use crate::{
    bench::Tick,
    phase::Pc,
    wire::{JointFrame, Motion},
};

/// C620 counts of 1 A.
const BRING_UP_COUNTS: i32 = 820;
const BRING_UP_NM: f32 = 0.5;
const AT_REST: Motion = Motion {
    pos_rad: 0.0,
    vel_rps: 0.0,
};

/// One tick with this frame on both buses.
fn with_frame(enabled: bool, id: u16, data: [u8; 8]) -> Phase {
    Phase {
        frame: (id, data.to_vec()),
        ..good(1, enabled)
    }
}

fn bring_up(step: u8, motor: u8, action: u8, value: i16) -> Phase {
    let [low, high] = value.to_le_bytes();
    with_frame(
        false,
        WRITE_ID.raw(),
        [opcode::BRING_UP, step, motor, action, low, high, 0, 0],
    )
}

/// A phase with the robot enabled, and the dead-man stick held or not.
fn stick(ticks: u16, held: bool) -> Phase {
    let mut phase = good(ticks, true);
    phase.channels[3] = if held { 1.0 } else { 0.0 };
    phase
}

fn run_all(make: Make, phases: &[Phase]) -> Vec<Tick> {
    // Requests large values all the time.
    let rogue = Rogue {
        joint: JointCommand {
            mode: robot_app::domain::JointMode::Mit,
            tau_nm: 2.5,
            ..JointCommand::default()
        },
        ..Rogue::wheels(5_000.0)
    };
    let mut bench = Bench::new(make, rogue);
    bench.run(phases);
    std::mem::take(&mut bench.ticks)
}

/// Torque of each joint's command, 0 for one without.
fn torques(ticks: &[Tick], make: Make) -> [f32; 4] {
    let mut torques = [0.0f32; 4];
    for tick in ticks {
        for (torque, frame) in torques.iter_mut().zip(&tick.joints) {
            match frame {
                Some(JointFrame::Mit(mit)) if !mit.is_off(make) => {
                    *torque = torque.max(mit.asked_nm(AT_REST).abs());
                }
                Some(JointFrame::PositionSpeed { .. } | JointFrame::Speed { .. }) => {
                    *torque = f32::INFINITY;
                }
                _ => {}
            }
        }
    }
    torques
}

fn most_counts(ticks: &[Tick]) -> i32 {
    let counts = ticks.iter().flat_map(|tick| tick.wheels.map(i32::abs));
    counts.max().unwrap_or(0)
}

#[test]
fn in_the_first_step_nothing_arms() {
    for make in [Make::Dm4310, Make::Rs00] {
        let phases = [good(1_500, false), bring_up(1, 0, 0, 0), stick(500, true)];
        let ticks = run_all(make, &phases);
        assert!(
            !ticks
                .iter()
                .any(|tick| tick.drives() || tick.enables_joints())
        );
        let off = [good(100, false), bring_up(0, 0, 0, 0), good(100, false)];
        let off = [&phases[..], &off].concat();
        let drive = [off, vec![good(500, true)]].concat();
        assert!(most_counts(&run_all(make, &drive)) > BRING_UP_COUNTS);
    }
}

#[test]
fn in_the_second_step_joints_are_enabled_without_torque() {
    for make in [Make::Dm4310, Make::Rs00] {
        let phases = [good(1_500, false), bring_up(2, 0, 0, 0), stick(500, true)];
        let ticks = run_all(make, &phases);
        assert_eq!(most_counts(&ticks), 0);
        assert_eq!(torques(&ticks, make), [0.0; 4]);
        assert!(ticks[ticks.len() - 2..].iter().any(Tick::enables_joints));
    }
}

#[test]
fn in_the_third_step_one_motor_turns_while_the_stick_is_held() {
    for make in [Make::Dm4310, Make::Rs00] {
        let start = [good(1_500, false), bring_up(3, 3, 0, 300)];
        let free = [&start[..], &[stick(300, false)]].concat();
        assert_eq!(torques(&run_all(make, &free), make), [0.0; 4]);
        let held = [&free[..], &[stick(300, true)]].concat();
        let ticks = run_all(make, &held);
        let [_, chosen, ..] = torques(&ticks, make);
        assert!((chosen - 0.3).abs() < 0.01, "{chosen}");
        assert_eq!(torques(&ticks, make), [0.0, chosen, 0.0, 0.0]);
        assert_eq!(most_counts(&ticks), 0);
        let let_go = [&held[..], &[stick(300, false)]].concat();
        let after = &run_all(make, &let_go)[held.iter().map(|p| usize::from(p.ticks)).sum()..];
        assert_eq!(torques(after, make), [0.0; 4]);
    }
}

/// Bring-up by radio has other uses for the mode switch, so its position at PC stops nothing, and a PC has no part in it.
#[test]
fn bring_up_needs_no_pc_in_mode_pc() {
    let make = Make::Dm4310;
    for pc in [Pc::Silent, Pc::asks(0.0, 0.0), Pc::asks(6.0, 0.5)] {
        let phases = [
            good(1_500, false),
            bring_up(3, 3, 0, 300),
            stick(300, false),
            stick(300, true),
        ]
        .map(|phase| in_mode_pc(&pc, phase));
        let ticks = run_all(make, &phases);
        let [_, chosen, ..] = torques(&ticks, make);
        assert!((chosen - 0.3).abs() < 0.01, "{chosen} {pc:?}");
        assert_eq!(torques(&ticks, make), [0.0, chosen, 0.0, 0.0]);
        assert_eq!(most_counts(&ticks), 0);
    }
}

fn in_mode_pc(pc: &Pc, phase: Phase) -> Phase {
    Phase {
        mode: DriveMode::Pc,
        pc: pc.clone(),
        ..phase
    }
}

/// The joint is at 0 and its range is −1.35 to −0.5 rad, as on a new robot whose zero is not set. 5 N·m/rad to the
/// limit would be 2.5 N·m.
#[test]
fn a_joint_beyond_its_soft_limit_is_held_softly() {
    let [a, b, c, d] = (-0.5f32).to_le_bytes();
    for make in [Make::Dm4310, Make::Rs00] {
        let phases = [
            good(1_500, false),
            with_frame(
                false,
                WRITE_ID.raw(),
                [opcode::WRITE_PARAMETER, 16, 3, 0, a, b, c, d],
            ),
            // Sticks must rest for 0.2 s by the new settings.
            good(300, false),
            bring_up(3, 2, 1, 0),
            stick(300, false),
            stick(300, true),
        ];
        let ticks = run_all(make, &phases);
        let replies = ticks.iter().flat_map(|tick| &tick.replies);
        assert_eq!(
            replies.filter(|reply| reply[0] == opcode::REFUSED).count(),
            0
        );
        let held =
            |tick: &Tick| matches!(tick.joints[0], Some(JointFrame::Mit(mit)) if !mit.is_off(make));
        assert!(ticks.iter().any(held));
        assert!(
            torques(&ticks, make)
                .iter()
                .all(|nm| *nm <= BRING_UP_NM + 0.05)
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// Applies to any values of the request and of the controller, if the request is accepted.
    #[test]
    fn bring_up_keeps_its_own_limits(
        (step, motor, action, value) in prop_oneof![
            1 => Just((2u8, 0u8, 0u8, 0i16)),
            4 => (Just(3u8), 0u8..6, 0u8..2, prop_oneof![Just(0), -1_100i16..1_100, any::<i16>()]),
        ],
        sticks in prop::collection::vec((1u16..400, any::<bool>()), 1..8),
        make in prop_oneof![Just(Make::Dm4310), Just(Make::Rs00)],
    ) {
        let held: Vec<bool> = std::iter::repeat_n(false, 1_501)
            .chain(sticks.iter().flat_map(|(ticks, held)| {
                std::iter::repeat_n(*held, usize::from(*ticks))
            }))
            .collect();
        let drive = sticks.iter().map(|(ticks, held)| stick(*ticks, *held));
        let phases = [good(1_500, false), bring_up(step, motor, action, value)];
        let phases: Vec<Phase> = phases.into_iter().chain(drive).collect();
        let ticks = run_all(make, &phases);
        prop_assume!(ticks.iter().any(|tick| tick.replies.iter().any(|reply| reply[0] == opcode::BRING_UP)));
        prop_assert!(most_counts(&ticks) <= BRING_UP_COUNTS);
        // Steps of the codes: 5/4095 · 33 rad/s and half a step of torque.
        prop_assert!(torques(&ticks, make).iter().all(|nm| *nm <= BRING_UP_NM + 0.05));
        for (tick, held) in ticks.iter().zip(held) {
            let moves = tick.drives() || torques(std::slice::from_ref(tick), make) != [0.0; 4];
            prop_assert!(held || !moves);
        }
    }
}

/// docs/tuning.md#frames: 60 mm, 420 mm, ratio 19.20, right wheel reversed; the reply echoes the request.
#[test]
fn wheel_geometry_changes_only_while_disarmed() {
    let request = [opcode::WRITE_GEOMETRY, 60, 0, 0xA4, 0x01, 0x80, 0x07, 0x02];
    let disarmed = [
        good(1_500, false),
        with_frame(false, WRITE_ID.raw(), request),
        good(10, false),
    ];
    let ticks = run_all(Make::Dm4310, &disarmed);
    let replies: Vec<_> = ticks.iter().flat_map(|tick| &tick.replies).collect();
    assert_eq!(replies, [&request; 2], "one on each bus");

    let armed = [
        good(1_500, false),
        good(300, true),
        with_frame(true, WRITE_ID.raw(), request),
        good(10, true),
    ];
    let ticks = run_all(Make::Dm4310, &armed);
    let replies: Vec<_> = ticks.iter().flat_map(|tick| &tick.replies).collect();
    assert_eq!(replies.len(), 2);
    for reply in replies {
        assert_eq!(
            reply[..2],
            [opcode::REFUSED, opcode::WRITE_GEOMETRY],
            "{reply:02X?}"
        );
    }
    assert!(ticks.last().is_some_and(Tick::drives), "the drive goes on");
}

/// A bring-up request while armed, or with the enable switch on, changes nothing.
#[test]
fn bring_up_does_not_start_while_armed() {
    for (step, motor) in [(1, 0), (2, 0), (3, 3)] {
        let mut request = bring_up(step, motor, 0, 300);
        request.enabled = true;
        let phases = [
            good(1_500, false),
            good(300, true),
            request,
            good(100, true),
        ];
        let ticks = run_all(Make::Dm4310, &phases);
        assert!(ticks.last().is_some_and(Tick::drives), "step {step}");
        let refused = ticks.iter().flat_map(|tick| &tick.replies);
        assert!(
            refused
                .clone()
                .all(|reply| reply[..2] == [opcode::REFUSED, opcode::BRING_UP])
        );
        assert_eq!(refused.count(), 2);
    }
}
