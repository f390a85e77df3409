use super::*;
use crate::{
    control::balance::tilt::Tilt,
    domain::robots::FIVEBAR,
    math::{Quaternion, scalar},
};

const TICK_S: f32 = 0.001;

/// A robot with both legs and its body at this lean in rad, turning at this rate in rad/s, whose joints tell another rate of lean.
fn leaning(rad: f32, rps: f32, told_rps: f32) -> Measured {
    let (sin, cos) = scalar::sin_cos(0.5 * rad);
    let attitude = Quaternion {
        w: cos,
        x: 0.0,
        y: sin,
        z: 0.0,
    };
    Measured {
        tilt: Tilt::new(attitude, [0.0, rps, 0.0]),
        lean_rad: [rad; 2],
        lean_rps: [told_rps; 2],
        ..Measured::at_rest()
    }
}

#[test]
fn a_robot_that_comes_up_slowly_is_turned_further_before_it_balances() {
    for side in [1.0, -1.0] {
        let balances = |rad: f32, rps: f32| can_balance(&leaning(side * rad, side * rps, 0.0));
        assert!(!balances(0.47, -2.6), "its centre of mass may be far out");
        assert!(balances(0.35, -2.6));
        assert!(balances(0.47, -3.6), "it is nearly there");
    }
}

#[test]
fn legs_that_strike_their_stops_do_not_make_a_robot_balance() {
    assert!(!can_balance(&leaning(0.47, -2.6, -4.0)));
    assert!(can_balance(&leaning(0.47, -3.6, -1.0)));
}

#[test]
fn an_estimate_that_drifted_while_the_robot_lay_is_not_believed() {
    let profile = &FIVEBAR.balance;
    let drifted = |measured: Measured| Measured {
        ground_mps: 1.0,
        ..measured
    };
    let lying = drifted(leaning(-0.8, 0.0, 0.0));
    let upright = drifted(leaning(-0.15, 1.0, 1.0));
    let mut stand_up = StandUp::new(&lying);
    let mut law = Law::new(profile, &lying);
    let mut step = |measured: &Measured| {
        stand_up.step(
            &mut law,
            profile,
            &FIVEBAR.wheel_odom,
            measured,
            0.15,
            TICK_S,
        );
        law.slip.rolling_mps(measured)
    };
    for _ in 0..(LIFT_S / TICK_S) as usize + 2 {
        step(&lying);
    }
    let told_mps = step(&upright);
    assert!(told_mps.abs() < 1e-6, "{told_mps}");
}
