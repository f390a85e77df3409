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

fn slip_of(measured: &Measured, ticks: usize) -> Slip {
    let mut slip = Slip::default();
    for _ in 0..ticks {
        slip.step(&FIVEBAR.wheel_odom, measured, [2.0; 2], true, TICK_S);
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
            slip.step(&FIVEBAR.wheel_odom, &rolling, [2.0; 2], true, TICK_S);
        }
        slip.lately_mps
    };
    let (soon_mps, later_mps) = (roll(0.5), roll(1.5));
    assert!(soon_mps > 0.7, "{soon_mps}");
    assert!((0.3..0.5).contains(&later_mps), "{later_mps}");
}

/// What is told of the speed, and whether a wheel slips, after 0.4 s of wheels at 1.0 m/s while the estimate tells 0.0.
fn beside_a_drift(wheels_nm: [f32; 2], loaded: bool) -> (f32, bool) {
    let rolling = measured([1.0, 1.0], 0.0, 0.0);
    let mut slip = Slip::default();
    for _ in 0..400 {
        slip.step(&FIVEBAR.wheel_odom, &rolling, wheels_nm, loaded, TICK_S);
    }
    (slip.rolling_mps(&rolling), slip.is_slipping())
}

#[test]
fn loaded_wheels_with_little_torque_roll_whatever_the_estimate_tells() {
    assert_eq!(beside_a_drift([0.5, -0.5], true), (1.0, false));
}

#[test]
fn wheels_with_torque_or_without_load_may_slip() {
    for (wheels_nm, loaded) in [([0.5, 0.7], true), ([-0.7, 0.5], true), ([0.5; 2], false)] {
        assert_eq!(beside_a_drift(wheels_nm, loaded), (ROLLING_MPS, true));
    }
}

#[test]
fn a_drift_is_forgotten_when_the_estimate_follows_its_wheels_again() {
    let drifted = measured([1.0, 1.0], 0.0, 0.0);
    let mut slip = Slip::default();
    for _ in 0..400 {
        slip.step(&FIVEBAR.wheel_odom, &drifted, [0.0; 2], true, TICK_S);
    }
    slip.step(
        &FIVEBAR.wheel_odom,
        &measured([1.0, 1.0], 0.9, 0.0),
        [2.0; 2],
        true,
        TICK_S,
    );
    let told = slip.rolling_mps(&measured([2.9, 2.9], 1.0, 0.0));
    assert!((told - 1.0 - ROLLING_MPS).abs() < 1e-6, "{told}");
}
