use super::*;
use crate::{control::balance::tilt::Tilt, domain::robots::FIVEBAR};

const TRACK_M: f32 = 0.42;

/// A robot at rest whose legs have these lengths in m.
fn on_legs(lengths_m: [f32; 2], roll_rad: f32, yaw_rps: f32) -> Measured {
    let rest = Measured::at_rest();
    let [mut left, mut right] = rest.legs;
    [left.length_m, right.length_m] = lengths_m;
    Measured {
        tilt: Tilt {
            roll_rad,
            yaw_rps,
            ..rest.tilt
        },
        legs: [left, right],
        ..rest
    }
}

#[test]
fn both_wheels_of_a_robot_that_rolls_in_the_air_come_down_at_once() {
    let mass = &FIVEBAR.balance.mass;
    for side in [1.0, -1.0] {
        // With its right side down the right hip is lower, and so its leg is shorter.
        let more_m = side * 0.5 * TRACK_M * 0.1;
        let level = on_legs([0.2 + more_m, 0.2 - more_m], side * 0.1, 0.0);
        for push_n in Support::in_air(mass, TRACK_M, &Ramp::at(0.2), &level) {
            assert!(push_n.abs() < 1e-3, "{push_n}");
        }
        for push_n in Support::one_in_air(mass, TRACK_M, &level) {
            assert!(push_n.abs() < 1e-3, "{push_n}");
        }
    }
}

/// Axles that are too fast by so much.
fn stance(off_mps: f32) -> Stance {
    Stance {
        length: Ramp::at(0.2),
        roll_rad: 0.0,
        sideways_mps2: 0.0,
        share: 1.0,
        off_mps,
        lean_rad: 0.0,
        across_nm: 0.0,
        longest_m: 0.3,
    }
}

/// Share by which the legs push more of a robot whose axles move too fast, all by so much; pushed backward it is the same.
fn more(off_mps: f32, speed_mps: f32, [lean_rad, lean_rps]: [f32; 2]) -> f32 {
    let [forward, backward] = [1.0, -1.0].map(|sign| {
        let measured = Measured {
            speed_mps: sign * speed_mps,
            lean_rad: [sign * lean_rad; 2],
            lean_rps: [sign * lean_rps; 2],
            ..Measured::at_rest()
        };
        let upright = Upright::new(0.2, 0.3, &measured);
        stance(sign * off_mps).easing(&measured, &upright)
    });
    assert!((forward - backward).abs() < 1e-6);
    forward
}

#[test]
fn legs_of_a_pushed_robot_push_for_grip_then_less_and_more_again_to_brake() {
    let lean_grows = more(1.5, 1.5, [0.1, 3.0]);
    assert!((0.4..=MOST_BRAKING).contains(&lean_grows), "{lean_grows}");
    let wheels_are_fast = more(1.5, 3.0, [0.2, 0.0]);
    assert!(
        (-0.35..-0.25).contains(&wheels_are_fast),
        "{wheels_are_fast}"
    );
    let lean_shrinks = more(1.5, 1.5, [0.3, -3.0]);
    assert!((-0.3..-0.1).contains(&lean_shrinks), "{lean_shrinks}");
    let brakes = more(1.5, 1.5, [-0.5, 0.0]);
    assert!((0.25..0.35).contains(&brakes), "{brakes}");
    assert_eq!(more(0.3, 0.3, [0.2, 3.0]), 0.0);
}

/// How much harder the right leg pushes than the left one, in N, on a robot that turns, once it has learned for a while what
/// holds it level.
fn harder_n(yaw_rps: f32, roll_rad: f32, learned_for: u32) -> f32 {
    let profile = &FIVEBAR.balance;
    let stance = stance(0.0);
    let mut support = Support::default();
    let mut step = |measured: &Measured, learning: bool| {
        let [left_n, right_n] =
            support.step(&profile.mass, TRACK_M, &stance, measured, learning, 0.001);
        right_n - left_n
    };
    for _ in 0..learned_for {
        step(&on_legs([0.2; 2], 0.01, 0.0), true);
    }
    step(&on_legs([0.2; 2], roll_rad, yaw_rps), false)
}

#[test]
fn a_turn_on_the_spot_holds_a_weight_beside_the_middle_against_its_centrifugal_force() {
    let (still_n, turning_n) = (harder_n(0.0, 0.0, 500), harder_n(8.0, 0.0, 500));
    let height_m = 0.2 + FIVEBAR.balance.mass.carried_up_m;
    let more = 1.0 + 64.0 * height_m / GRAVITY_MPS2;
    assert!(still_n > 0.1, "{still_n}");
    assert!((turning_n / still_n - more).abs() < 0.01, "{turning_n}");
    let stiffer_n = harder_n(8.0, 0.05, 0) - harder_n(0.0, 0.05, 0);
    let weight_n = FIVEBAR.balance.mass.carried_kg * 64.0 * height_m * height_m * 0.05 / TRACK_M;
    assert!((stiffer_n - 2.0 * weight_n).abs() < 0.01, "{stiffer_n}");
}
