//! Motion after a partial stop.

use super::*;

/// Returns whether wheels and joints are stopped during a partial stop, after it with the sticks deflected, and after
/// the sticks have been centred.
fn stops_around(begin: fn(&mut Bench), end: fn(&mut Bench)) -> [(bool, bool); 3] {
    let mut bench = Bench::new();
    let stops = |bench: &mut Bench| {
        let status = bench.run(20);
        let bus_1 = BusId::Can1;
        (status.stops_wheels(bus_1), status.stops_joints(BusId::Can2))
    };
    bench.may_resume = false;
    begin(&mut bench);
    let during = stops(&mut bench);
    end(&mut bench);
    let pushed = stops(&mut bench);
    let awaited = bench.tick().flags.intersects(SafetyFlags::STICKS_AWAITED);
    assert_eq!(awaited, pushed != (false, false));
    bench.may_resume = true;
    let centred = stops(&mut bench);
    assert!(!bench.tick().flags.intersects(SafetyFlags::STICKS_AWAITED));
    bench.may_resume = false;
    assert_eq!(stops(&mut bench), centred);
    [during, pushed, centred]
}

#[test]
fn after_a_partial_stop_the_part_waits_for_centred_sticks() {
    let joints = [(false, true), (false, true), (false, false)];
    let wheels = [(true, false), (true, false), (false, false)];
    let silent_joint = stops_around(
        |b| b.motor.joints[1].age_us = 60_000,
        |b| b.motor.joints[1].age_us = 2_000,
    );
    assert_eq!(silent_joint, joints);
    let bus_off = stops_around(
        |b| b.health.can[1].state = BusErrorState::BusOff,
        |b| b.health.can[1].state = BusErrorState::Active,
    );
    assert_eq!(bus_off, joints);
    let congested = stops_around(
        |b| b.health.can[0].tx_failures_in_row = 21,
        |b| b.health.can[0].tx_failures_in_row = 0,
    );
    assert_eq!(congested, wheels);
}

/// During the silence its current continues open loop. A wheel that regains its supply must not start by itself.
#[test]
fn a_wheel_that_was_silent_waits_for_centred_sticks() {
    let open_loop = [(false, false), (true, false), (false, false)];
    for wheel in [
        stops_around(
            |b| b.motor.wheels[0].age_us = 60_000,
            |b| b.motor.wheels[0].age_us = 1_000,
        ),
        stops_around(
            |b| b.motor.wheels[1].age_us = 60_000,
            |b| b.motor.wheels[1].age_us = 1_000,
        ),
    ] {
        assert_eq!(wheel, open_loop);
    }
}

#[test]
fn a_setting_allows_immediate_resumption() {
    let at_once = stops_around(
        |b| {
            b.config.resume_centred = 0;
            b.motor.joints[1].age_us = 60_000;
        },
        |b| b.motor.joints[1].age_us = 2_000,
    );
    assert_eq!(at_once, [(false, true), (false, false), (false, false)]);
}

/// A second cause that begins during the first one's stop is remembered as well.
#[test]
fn centred_sticks_count_only_after_all_causes_have_ended() {
    let mut bench = Bench::new();
    bench.may_resume = false;
    bench.motor.joints[1].age_us = 60_000;
    bench.run(5);
    bench.may_resume = true;
    assert!(bench.run(5).joints_stop);
    bench.may_resume = false;
    bench.motor.joints[1].age_us = 2_000;
    assert!(bench.run(5).joints_stop);
    bench.may_resume = true;
    assert!(!bench.run(1).joints_stop);
}
