//! A low and an empty battery.

use super::*;

/// Arming is blocked after a second below 21 V and allowed again at 21.5 V.
#[test]
fn a_low_battery_warns_and_recovers_with_hysteresis() {
    let mut bench = Bench::new();
    bench.health.battery_v = 20.9;
    assert_eq!(bench.ms_until(SafetyFlags::BATTERY_LOW), Some(1_000));
    let low = bench.run(5_000);
    assert_eq!(
        (low.flags, low.verdict),
        (SafetyFlags::BATTERY_LOW, SafetyVerdict::Run)
    );
    bench.health.battery_v = 21.4;
    assert_eq!(bench.run(3_000).flags, SafetyFlags::BATTERY_LOW);
    bench.health.battery_v = 21.5;
    assert_eq!(bench.run(1).flags, SafetyFlags::NONE);
}

#[test]
fn an_empty_battery_stops_everything_until_cleared_and_a_sag_does_not() {
    let mut bench = Bench::new();
    for _ in 0..10 {
        bench.health.battery_v = 15.0;
        assert!(!bench.run(998).global_stop);
        bench.health.battery_v = 24.0;
        assert!(!bench.run(1).global_stop);
    }
    bench.health.battery_v = 18.9;
    assert_eq!(bench.ms_until(SafetyFlags::BATTERY_EMPTY), Some(1_000));
    bench.health.battery_v = 24.0;
    let later = bench.run(5_000);
    assert_eq!(later.flags, SafetyFlags::BATTERY_EMPTY);
    assert_eq!(stops(&later), [true; 4]);
}

#[test]
fn an_unmeasured_battery_is_low_and_nan_is_empty() {
    let mut bench = Bench::new();
    bench.health.battery_v = 0.0;
    assert_eq!(bench.run(5_000).flags, SafetyFlags::BATTERY_LOW);
    bench.health.battery_v = f32::NAN;
    assert!(bench.run(1_000).global_stop);
    let mut unwatched = Bench::new();
    unwatched.config.battery_low_v = 0.0;
    for battery_v in [0.0, 12.0] {
        unwatched.health.battery_v = battery_v;
        assert_eq!(unwatched.run(5_000).flags, SafetyFlags::NONE);
    }
}
