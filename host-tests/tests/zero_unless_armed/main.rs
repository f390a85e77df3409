//! Whatever comes in: no torque unless every condition of design.md section 3 holds, never more than the limit, no
//! panic, no NaN in the estimate. The conditions are written here from the rules, from what goes into the tick alone.

mod controllers;
mod phase;
mod rules;

use controllers::{Integrator, Rogue};
use phase::{Phase, Producers, good, phases};
use proptest::prelude::*;
use robot_app::{
    control::ChassisController,
    domain::{BusErrorState, BusId, CanFrame, RobotConfig, StandardId, StateEstimate},
    tick::ControlLoop,
};
use rules::Rules;

/// C620 counts of the 8 A limit: 8000 · 16384 / 20000, rounded up.
const LIMIT_COUNTS: i32 = 6_554;

fn sent_counts(frames: &[(BusId, CanFrame)]) -> [i32; 4] {
    let [(BusId::Can1, frame)] = frames else {
        panic!("one command frame a tick, on CAN1");
    };
    assert_eq!(frame.id().raw(), 0x200);
    let data = frame.full_payload().expect("eight bytes");
    std::array::from_fn(|slot| i16::from_be_bytes([data[2 * slot], data[2 * slot + 1]]).into())
}

/// Whatever the sensors said, what comes out is a rotation and finite numbers.
fn assert_sound(estimate: &StateEstimate) {
    let squared: f32 = estimate.q_wxyz.iter().map(|part| part * part).sum();
    assert!((squared - 1.0).abs() < 1e-4, "{estimate:?}");
    let vectors = [
        estimate.rpy_rad,
        estimate.vel_mps,
        estimate.pos_m,
        estimate.gyro_bias_rps,
    ];
    assert!(vectors.iter().flatten().all(|part| part.is_finite()));
}

/// Runs the phases; what each tick sent, if it may be anything but zero, in C620 counts of the left wheel.
fn run(phases: &[Phase], controller: impl ChassisController) -> Vec<i32> {
    let mut control = ControlLoop::new(RobotConfig::default(), controller);
    let (mut rules, mut producers) = (Rules::default(), Producers::default());
    let mut now_us = 1_000_000u64;
    let mut left = Vec::new();
    for phase in phases {
        now_us = now_us.saturating_add(phase.time_jump_us);
        for tick in 0..phase.ticks {
            now_us = now_us.saturating_add(1_000);
            producers.run(phase, tick, now_us);
            let id = StandardId::new(phase.frame.0 & 0x7FF).expect("11 bits");
            let frame = CanFrame::from_payload(id, &phase.frame.1).expect("at most eight bytes");
            control.on_can_frame(BusId::Can1, &frame, now_us);
            let inputs = producers.inputs();
            let allowed = rules.allow(&inputs, now_us);
            let outputs = control.tick(&inputs, now_us);
            let counts = sent_counts(outputs.frames);
            let zero = counts == [0; 4];
            assert!(allowed || zero, "torque {counts:?} at {now_us} µs");
            assert!(counts.iter().all(|count| count.abs() <= LIMIT_COUNTS));
            assert_eq!(counts[2..], [0, 0]);
            assert_sound(outputs.estimate);
            rules.driving |= !zero;
            left.push(counts[0]);
        }
    }
    left
}

/// Ticks with torque.
fn driven(phases: &[Phase], demand_ma: f32) -> usize {
    let left = run(phases, Rogue(demand_ma));
    left.iter().filter(|counts| **counts != 0).count()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_moves_the_robot_against_the_rules(
        phases in phases(),
        demand_ma in prop_oneof![Just(5_000.0), any::<f32>()],
    ) {
        run(&phases, Rogue(demand_ma));
    }
}

/// Without this the property above could hold because nothing ever arms.
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

/// Each of these ends the drive, and the robot does not start again when it is over.
#[test]
fn every_cause_disarms_until_the_switch_moves() {
    type Cause = fn(&mut Phase);
    let causes: [(&str, Cause); 9] = [
        ("switch", |phase| phase.enabled = false),
        ("e-stop", |phase| phase.e_stop = true),
        ("failsafe", |phase| phase.failsafe = true),
        ("quality", |phase| phase.quality = 0.4),
        ("silence", |phase| phase.radio_sends = false),
        ("imu", |phase| phase.imu_sends = false),
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
    bus_off.can1 = BusErrorState::BusOff;
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
fn a_direct_command_passes_the_controller_by_and_nothing_else() {
    let cases = [
        (1_000.0, 819),
        (-f32::INFINITY, 1 - LIMIT_COUNTS),
        (f32::NAN, 0),
    ];
    for (direct_ma, counts) in cases {
        let mut drive = good(100, true);
        drive.direct_ma = Some(direct_ma);
        let mut unarmed = good(1_000, false);
        unarmed.direct_ma = Some(direct_ma);
        let left = run(&[unarmed, drive], Rogue(5_000.0));
        assert_eq!(left[..1_000], [0; 1_000]);
        assert_eq!(left[1_010..], [counts; 90]);
    }
}
