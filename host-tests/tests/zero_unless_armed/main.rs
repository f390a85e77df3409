//! Whatever comes in: no torque unless every condition of docs/safety.md#the-rules holds, never more than the limits, no
//! frame but those a motor or a tuner knows, no panic, no NaN in the estimate. The conditions are written here from the
//! rules, from what goes into the tick alone.

mod bench;
mod controllers;
mod motors;
mod pc;
mod phase;
mod producers;
mod replies;
mod requests;
mod rules;
mod standing;
mod stops;
mod walk;
mod wire;

use bench::{Bench, LIMIT_COUNTS};
use controllers::{Integrator, Rogue, Unsure};
use phase::{Phase, good, joint_command, phases};
use proptest::prelude::*;
use robot_app::{
    control::ChassisController,
    domain::{BusErrorState, JointCommand},
};
use wire::Make;

/// Current sent to the left wheel in each tick, in C620 counts.
fn run(phases: &[Phase], controller: impl ChassisController) -> Vec<i32> {
    let mut bench = Bench::new(Make::Dm4310, controller);
    bench.run(phases);
    bench.ticks.iter().map(|tick| tick.wheels[0]).collect()
}

/// Ticks with torque.
fn driven(phases: &[Phase], demand_ma: f32) -> usize {
    let left = run(phases, Rogue::wheels(demand_ma));
    left.iter().filter(|counts| **counts != 0).count()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_moves_the_robot_against_the_rules(
        phases in phases(),
        current_ma in prop_oneof![Just(5_000.0), any::<f32>()],
        joint in joint_command(),
        make in prop_oneof![Just(Make::Dm4310), Just(Make::Rs00)],
    ) {
        let rogue = Rogue { joint, ..Rogue::wheels(current_ma) };
        Bench::new(make, rogue).run(&phases);
    }
}

/// Without this test the property above would hold even if nothing ever armed.
#[test]
fn with_everything_in_order_the_rogue_drives_at_its_limit() {
    let driven = driven(&[good(1_000, false), good(500, true)], f32::INFINITY);
    assert_eq!(driven, 500);
}

#[test]
fn a_controller_that_asks_for_nan_gets_zero() {
    let driven = driven(&[good(1_000, false), good(500, true)], f32::NAN);
    assert_eq!(driven, 0);
}

#[test]
fn an_output_that_is_not_valid_is_zero() {
    let left = run(
        &[good(1_000, false), good(500, true)],
        Unsure(Rogue::wheels(5_000.0)),
    );
    assert_eq!(left, [0; 1_500]);
}

/// Each cause ends the drive, and the robot does not start again when the cause is over.
#[test]
fn every_cause_disarms_until_the_switch_is_cycled() {
    type Cause = fn(&mut Phase);
    let causes: [(&str, Cause); 11] = [
        ("switch", |phase| phase.enabled = false),
        ("e-stop", |phase| phase.e_stop = true),
        ("failsafe", |phase| phase.failsafe = true),
        ("quality", |phase| phase.quality = 0.4),
        ("quality nan", |phase| phase.quality = f32::NAN),
        ("silence", |phase| phase.radio_sends = false),
        ("imu", |phase| phase.imu_sends = false),
        ("late task", |phase| phase.late_task = true),
        ("imu errors", |phase| phase.imu_errors = 100),
        ("nan", |phase| phase.gyro = [f32::NAN; 3]),
        ("overflow", |phase| phase.accel = [f32::MAX; 3]),
    ];
    for (name, cause) in causes {
        let mut bad = good(200, true);
        cause(&mut bad);
        let mut after = good(4_000, true);
        after.imu_errors = bad.imu_errors;
        let drive = [good(1_000, false), good(100, true)];
        let before = driven(&drive, 5_000.0);
        assert_eq!(before, 100);
        let with_cause = [drive.to_vec(), vec![bad]].concat();
        let until_then = driven(&with_cause, 5_000.0);
        assert!(until_then <= 210, "{name}: {until_then} ticks");
        if name != "switch" {
            let and_after = [with_cause, vec![after]].concat();
            assert_eq!(driven(&and_after, 5_000.0), until_then, "{name}");
        }
    }
}

/// 100 ticks of 1 mA each are 81 counts. What cuts the wheels off also empties the controller's memory: switched off,
/// their bus gone, no command.
#[test]
fn a_controller_with_memory_starts_each_drive_fresh() {
    let drive = |ticks| good(ticks, true);
    let mut bus_off = drive(100);
    bus_off.buses[0] = BusErrorState::BusOff;
    let mut no_command = drive(150);
    no_command.logic_sends = false;
    for pause in [good(100, false), bus_off, no_command] {
        let phases = [good(1_000, false), drive(100), pause, drive(100)];
        let left = run(&phases, Integrator(0.0));
        assert_eq!(left.last(), Some(&81), "{:?}", phases[2]);
        assert_eq!(left[1_099], 81);
    }
}

/// 1000 mA are 819 counts. A direct command needs the same permit as any other, and has the same limit.
#[test]
fn a_direct_command_bypasses_only_the_controller() {
    let cases = [
        (1_000.0, 819),
        (-f32::INFINITY, 1 - LIMIT_COUNTS),
        (f32::NAN, 0),
    ];
    for (direct_ma, counts) in cases {
        let direct = Some((direct_ma, JointCommand::default()));
        let mut drive = good(100, true);
        drive.direct = direct;
        let mut unarmed = good(1_000, false);
        unarmed.direct = direct;
        let left = run(&[unarmed, drive], Rogue::wheels(5_000.0));
        assert_eq!(left[..1_000], [0; 1_000]);
        assert_eq!(left[1_010..], [counts; 90]);
    }
}
