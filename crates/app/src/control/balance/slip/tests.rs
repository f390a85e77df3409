use super::*;
use crate::{control::balance::tilt::Tilt, domain::robots::FIVEBAR};

const TICK_S: f32 = 0.001;

/// A robot whose wheels turn at these speeds in m/s, while it rolls at `ground_mps` and turns at `yaw_rps`.
fn measured(wheels_mps: [f32; 2], ground_mps: f32, yaw_rps: f32) -> Measured {
    let rest = Measured::at_rest();
    let [left_mps, right_mps] = wheels_mps;
    Measured {
        tilt: Tilt {
            yaw_rps,
            ..rest.tilt
        },
        wheel_rps: wheels_mps.map(|mps| mps / FIVEBAR.wheel_odom.wheel_radius_m),
        speed_mps: 0.5 * (left_mps + right_mps),
        ground_mps,
        ..rest
    }
}

/// Goes on by a tick.
fn step(slip: &mut Slip, measured: &Measured, wheels_nm: [f32; 2], loaded: bool) {
    let wheel_kgm2 = FIVEBAR.balance.mass.wheel_kgm2;
    slip.step(
        &FIVEBAR.wheel_odom,
        wheel_kgm2,
        measured,
        wheels_nm,
        loaded,
        TICK_S,
    );
}

fn slip_of(measured: &Measured, ticks: usize) -> Slip {
    let mut slip = Slip::default();
    for _ in 0..ticks {
        step(&mut slip, measured, [2.0; 2], true);
    }
    slip
}

#[test]
fn wheels_that_roll_or_turn_the_robot_do_not_slip() {
    let turn_mps = 0.5 * FIVEBAR.wheel_odom.wheel_track_m * 4.0;
    let turning = measured([1.0 - turn_mps, 1.0 + turn_mps], 1.0, 4.0);
    let slip = slip_of(&turning, 50);
    assert!(!slip.is_slipping());
    assert_eq!(slip.within_grip([3.0, -3.0]), [3.0, -3.0]);
    assert_eq!(slip.rolling_mps(&measured([1.1, 1.1], 1.0, 0.0)), 1.1);
}

#[test]
fn a_wheel_that_spins_is_slipping_after_a_moment() {
    let spinning = measured([1.0, 2.0], 1.0, 0.0);
    assert!(!slip_of(&spinning, 10).is_slipping());
    assert!(slip_of(&spinning, 30).is_slipping());
}

#[test]
fn torque_that_only_makes_a_wheel_spin_is_taken_away() {
    for sign in [1.0, -1.0] {
        let slip = slip_of(&measured([sign * 2.5, sign * 2.0], sign, 0.0), 1);
        let [left_nm, right_nm] = slip.within_grip([sign * 4.0, sign * 4.0]);
        assert_eq!(left_nm, 0.0);
        assert!(sign * right_nm > 0.5 && sign * right_nm < 3.5);
        let braking_nm = [sign * -4.0; 2];
        assert_eq!(slip.within_grip(braking_nm), braking_nm);
    }
}

#[test]
fn the_estimate_limits_what_spinning_wheels_tell_of_the_speed() {
    let told = Slip::default().rolling_mps(&measured([2.9, 2.9], 1.0, 0.0));
    assert!((told - 1.0 - ROLLING_MPS).abs() < 1e-6);
}

#[test]
fn a_spin_is_remembered_for_two_seconds() {
    let mut slip = slip_of(&measured([1.0, 2.0], 1.0, 0.0), 1);
    assert!((slip.lately_mps - 1.0).abs() < 1e-6, "{slip:?}");
    let rolling = measured([1.0, 1.0], 1.0, 0.0);
    let mut roll = |seconds: f32| {
        for _ in 0..(seconds / TICK_S) as usize {
            step(&mut slip, &rolling, [2.0; 2], true);
        }
        slip.lately_mps
    };
    let (soon_mps, later_mps) = (roll(0.5), roll(1.5));
    assert!(soon_mps > 0.7, "{soon_mps}");
    assert!((0.3..0.5).contains(&later_mps), "{later_mps}");
}

/// What is told of the speed, and whether a wheel slips, after 0.4 s of wheels that turned at 3.0 m/s and gain
/// `accel_mps2`, while the estimate tells 0.0. Backward it is the same.
fn beside_a_drift(wheels_nm: [f32; 2], accel_mps2: f32, loaded: bool) -> (f32, bool) {
    let [forward, backward] = [1.0, -1.0].map(|sign| {
        let mut slip = Slip::default();
        let mut now = measured([0.0; 2], 0.0, 0.0);
        for tick in 0..400 {
            let mps = sign * (3.0 + accel_mps2 * TICK_S * tick as f32);
            now = measured([mps; 2], 0.0, 0.0);
            step(&mut slip, &now, wheels_nm.map(|nm| sign * nm), loaded);
        }
        (sign * slip.rolling_mps(&now), slip.is_slipping())
    });
    assert_eq!(forward, backward);
    forward
}

#[test]
fn loaded_wheels_that_little_holds_back_roll_whatever_the_estimate_tells() {
    for wheels_nm in [[0.5, -0.5], [0.3, 0.1], [-2.0, -1.0]] {
        assert_eq!(beside_a_drift(wheels_nm, 0.0, true), (3.0, false));
    }
    // Their torque only turns them.
    let radius_m = FIVEBAR.wheel_odom.wheel_radius_m;
    let accel_mps2 = 0.3 * radius_m / FIVEBAR.balance.mass.wheel_kgm2;
    let (told_mps, slips) = beside_a_drift([0.3; 2], accel_mps2, true);
    assert!(told_mps > 3.5 && !slips, "{told_mps}");
}

#[test]
fn wheels_that_friction_brakes_or_without_load_may_slip() {
    for (wheels_nm, loaded) in [([0.5, 0.7], true), ([0.5; 2], false), ([0.0; 2], false)] {
        let told = beside_a_drift(wheels_nm, 0.0, loaded);
        assert_eq!(told, (ROLLING_MPS, true));
    }
    // On ice with a grip of 0.1 they have no torque, and lose speed.
    let radius_m = FIVEBAR.wheel_odom.wheel_radius_m;
    let brakes_mps2 = -0.27 * radius_m / FIVEBAR.balance.mass.wheel_kgm2;
    let told = beside_a_drift([0.0; 2], brakes_mps2, true);
    assert_eq!(told, (ROLLING_MPS, true));
}

#[test]
fn a_drift_is_forgotten_when_the_estimate_follows_its_wheels_again() {
    let drifted = measured([1.0, 1.0], 0.0, 0.0);
    let mut slip = Slip::default();
    for _ in 0..400 {
        step(&mut slip, &drifted, [0.0; 2], true);
    }
    step(&mut slip, &measured([1.0, 1.0], 0.9, 0.0), [2.0; 2], true);
    let told = slip.rolling_mps(&measured([2.9, 2.9], 1.0, 0.0));
    assert!((told - 1.0 - ROLLING_MPS).abs() < 1e-6, "{told}");
}
