//! A PC steers an armed robot in mode PC, from rest and while it is heard. It arms nothing.

use super::*;
use crate::phase::{Pc, good_pc, pc};
use robot_app::domain::DriveMode;

fn bench() -> Bench<Rogue> {
    // No command of the controller reaches a motor in mode PC.
    Bench::new(Make::Dm4310, Rogue::wheels(5_000.0))
}

fn rest() -> Pc {
    Pc::asks(0.0, 0.0)
}

fn motion() -> Pc {
    Pc::asks(6.0, 0.0)
}

/// Ticks of the last phase in which the wheels get current.
fn driven_in_last(phases: &[Phase]) -> usize {
    let mut bench = bench();
    bench.run(phases);
    let last = usize::from(phases.last().expect("a phase").ticks);
    let ticks = &bench.ticks[bench.ticks.len() - last..];
    ticks.iter().filter(|tick| tick.drives()).count()
}

/// An armed robot in mode PC whose PC rests, then this.
fn armed_then(phases: &[Phase]) -> Vec<Phase> {
    let start = [good_pc(1_000, false, rest()), good_pc(300, true, rest())];
    [&start, phases].concat()
}

/// The wheels of the bench turn at 60 rpm of their rotors, which is 0.327 rad/s. On the wire a damping of 0.15 becomes 10
/// steps of 1000/65535: 0.1526 · (6 − 0.327) N·m = 0.866 N·m are 2.886 A or 2364 counts. The right motor sits mirrored and
/// turns backwards: 6.327 rad/s, 2636 counts.
#[test]
fn with_everything_in_order_the_pc_drives() {
    let mut bench = bench();
    bench.run(&armed_then(&[good_pc(100, true, motion())]));
    let [left, right] = bench.ticks.last().expect("a tick").wheels;
    assert!(
        (left - 2_364).abs() < 4 && (right + 2_636).abs() < 4,
        "{left} {right}"
    );
    let joints = bench.ticks.iter().filter(|tick| tick.enables_joints());
    assert!(joints.count() > 100);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the PC sends, the switch has not been seen off and then on.
    #[test]
    fn no_stream_arms_the_robot(streams in prop::collection::vec(pc(), 1..6), enabled: bool) {
        let phases: Vec<Phase> = streams
            .into_iter()
            .map(|pc| good_pc(300, enabled, pc))
            .collect();
        let mut bench = bench();
        bench.run(&phases);
        prop_assert!(!bench.ticks.iter().any(|tick| tick.drives() || tick.enables_joints()));
    }

    /// Whatever the PC sends, it has no effect in the other modes.
    #[test]
    fn no_stream_moves_a_robot_in_another_mode(stream in pc(), custom: bool) {
        let mode = if custom { DriveMode::Custom } else { DriveMode::Manual };
        let [off, on] = [(1_000, false), (300, true)].map(|(ticks, enabled)| Phase {
            mode,
            pc: stream.clone(),
            ..good(ticks, enabled)
        });
        let [quiet_off, quiet_on] = [&off, &on].map(|phase| Phase {
            pc: Pc::Silent,
            ..phase.clone()
        });
        let (mut disturbed, mut quiet) = (bench(), bench());
        disturbed.run(&[off, on]);
        quiet.run(&[quiet_off, quiet_on]);
        // The tuning channel is open to a PC as it is on a bus.
        prop_assert!(disturbed.tuned || disturbed.ticks == quiet.ticks);
    }

    /// The last frame of a phase comes 9 ticks before its end, or up to 9 ticks before that.
    #[test]
    fn after_a_gap_only_a_pc_within_the_age_limit_goes_on(gap in 1u16..200, driving in 1u16..30) {
        let stream = [good_pc(driving, true, motion())];
        let silence = [good_pc(gap, true, Pc::Silent)];
        let since_last = (driving - 1) % 10 + 1;
        let with_torque = driven_in_last(&armed_then(&[stream.clone(), silence.clone()].concat()));
        let expected = (101 - since_last).min(gap);
        prop_assert_eq!(with_torque, usize::from(expected));
        let again = [good_pc(50, true, motion())];
        let goes_on = gap + since_last <= 101;
        let phases = armed_then(&[&stream[..], &silence, &again].concat());
        prop_assert_eq!(driven_in_last(&phases), if goes_on { 50 } else { 0 });
        let fresh = [good_pc(20, true, rest()), good_pc(50, true, motion())];
        let phases = armed_then(&[&stream[..], &silence, &again, &fresh].concat());
        prop_assert_eq!(driven_in_last(&phases), 50);
    }
}

#[test]
fn a_pc_in_motion_does_not_start_when_the_robot_is_armed() {
    let drive = good_pc(500, true, motion());
    let phases = [good_pc(1_000, false, motion()), drive.clone()];
    assert_eq!(driven_in_last(&phases), 0);
    let phases = [&phases[..], &[good_pc(10, true, rest()), drive]].concat();
    assert_eq!(driven_in_last(&phases), 500);
}

/// The joints stay at 0 rad, and a leg must not swing by a third of a radian at once.
#[test]
fn a_pc_whose_pose_is_elsewhere_does_not_start() {
    for (pos_rad, starts) in [(0.0, true), (0.09, true), (0.11, false), (0.3, false)] {
        let mut bench = bench();
        let aside = Pc::asks(0.0, pos_rad);
        bench.run(&[
            good_pc(1_000, false, aside.clone()),
            good_pc(500, true, aside),
        ]);
        let last = bench.ticks.split_off(bench.ticks.len() - 100);
        let commanded = last.iter().flat_map(|tick| tick.joints).flatten();
        let mut stiffness = commanded.filter_map(|frame| frame.stiffness());
        assert_eq!(stiffness.any(|kp| kp > 0.0), starts, "{pos_rad}");
    }
}

#[test]
fn the_pilot_takes_over_and_gives_back_only_from_rest() {
    let manual = Phase {
        mode: DriveMode::Manual,
        pc: motion(),
        ..good(200, true)
    };
    let drive = good_pc(200, true, motion());
    let phases = armed_then(&[drive.clone(), manual.clone()]);
    // The controller takes over with the next decision.
    assert!(driven_in_last(&phases) >= 190);
    let phases = [&phases[..], std::slice::from_ref(&drive)].concat();
    assert_eq!(driven_in_last(&phases), 0);
    let phases = [&phases[..], &[good_pc(10, true, rest()), drive]].concat();
    assert_eq!(driven_in_last(&phases), 200);
}

#[test]
fn after_a_stop_of_everything_the_pilot_arms_and_the_pc_begins_at_rest() {
    let drive = good_pc(200, true, motion());
    let mut stop = good_pc(100, true, motion());
    stop.e_stop = true;
    let stopped = armed_then(&[drive.clone(), stop]);
    let phases = [&stopped[..], std::slice::from_ref(&drive)].concat();
    assert_eq!(driven_in_last(&phases), 0, "not armed");
    let armed_again = [
        &stopped[..],
        &[good_pc(300, false, motion()), drive.clone()],
    ]
    .concat();
    assert_eq!(driven_in_last(&armed_again), 0, "not from rest");
    let from_rest = [&armed_again[..], &[good_pc(10, true, rest()), drive]].concat();
    assert_eq!(driven_in_last(&from_rest), 200);
}
