use super::*;
use crate::domain::robots::FIVEBAR;

/// Torques on both legs in N·m of a robot in the air whose legs lean.
fn lean_nm(ground: Ground) -> [f32; 2] {
    let measured = Measured {
        lean_rad: [0.1, -0.2],
        ..Measured::at_rest()
    };
    let goal = Goal {
        ground,
        ..Goal::upright(Ramp::at(0.2))
    };
    let mut law = Law::new(&FIVEBAR.balance, &measured);
    let (_, legs) = law.in_air(&FIVEBAR.balance, &FIVEBAR.wheel_odom, &measured, &goal);
    legs.map(|leg| leg.lean_nm)
}

#[test]
fn a_robot_that_left_the_ground_by_itself_holds_its_legs_harder() {
    let [left_nm, right_nm] = lean_nm(Ground::Felt);
    assert!(
        left_nm < -1.0 && right_nm > 2.0,
        "back to below: {left_nm} {right_nm}"
    );
    assert_eq!(lean_nm(Ground::Left), [2.0 * left_nm, 2.0 * right_nm]);
}

const TICK_S: f32 = 0.001;

/// A robot whose wheels roll at a speed, and that falls freely where it is not `loaded`.
fn rolling(speed_mps: f32, loaded: bool) -> Measured {
    let rest = Measured::at_rest();
    Measured {
        speed_mps,
        ground_mps: speed_mps,
        up_mps2: if loaded { rest.up_mps2 } else { 0.0 },
        // Some 40 N on each leg.
        hip_nm: if loaded {
            [[-3.0, 3.0]; 2]
        } else {
            rest.hip_nm
        },
        wheel_rps: [speed_mps / FIVEBAR.wheel_odom.wheel_radius_m; 2],
        ..rest
    }
}

fn step(law: &mut Law, measured: &Measured) {
    let goal = Goal {
        stop: true,
        ground: Ground::Felt,
        ..Goal::upright(Ramp::at(0.2))
    };
    let (profile, odometry) = (&FIVEBAR.balance, &FIVEBAR.wheel_odom);
    law.step(profile, odometry, measured, &goal, TICK_S);
}

/// Time in s until a robot flies that falls freely from now on.
fn flies_after_s(law: &mut Law, speed_mps: f32) -> f32 {
    let mut lasts_s = 0.0;
    loop {
        step(law, &rolling(speed_mps, false));
        lasts_s += TICK_S;
        assert!(lasts_s < 1.0);
        if law.airborne() {
            return lasts_s;
        }
    }
}

fn standing() -> Law {
    Law::new(&FIVEBAR.balance, &Measured::at_rest())
}

#[test]
fn legs_of_a_pushed_robot_may_push_nothing_for_a_moment() {
    let seconds = flies_after_s(&mut standing(), 0.0);
    assert!(seconds < 0.03, "{seconds}");
    for speed_mps in [0.8, -0.8] {
        let seconds = flies_after_s(&mut standing(), speed_mps);
        assert!((0.19..0.25).contains(&seconds), "{seconds}");
    }
}

/// Hands that shake it load its wheels for moments.
#[test]
fn a_robot_that_is_carried_is_not_caught_again_and_again() {
    let mut law = standing();
    flies_after_s(&mut law, 0.8);
    for _ in 0..20 {
        step(&mut law, &rolling(0.8, true));
    }
    assert!(!law.airborne());
    let seconds = flies_after_s(&mut law, 0.8);
    assert!(seconds < 0.05, "{seconds}");
}

/// Torques on both legs in N·m of a body that is 0.01 rad askew.
fn askew_nm(loose_s: f32, speed_mps: f32) -> ([f32; 2], f32) {
    let mut measured = rolling(speed_mps, true);
    measured.tilt.pitch_rad = 0.01;
    let mut law = Law::new(&FIVEBAR.balance, &measured);
    law.loose_s = loose_s;
    let goal = Goal::upright(Ramp::at(0.2));
    let (profile, odometry) = (&FIVEBAR.balance, &FIVEBAR.wheel_odom);
    let (_, legs) = law.on_ground(profile, odometry, &measured, &goal, TICK_S);
    (legs.map(|leg| leg.lean_nm), law.loose_s)
}

#[test]
fn hips_are_loosened_for_a_while_after_a_push_once_the_robot_rests() {
    let ([held_nm, _], _) = askew_nm(0.0, 0.0);
    let (loose, left_s) = askew_nm(LOOSE_S, 0.0);
    for nm in loose {
        assert!(
            (nm.abs() - held_nm.abs() - 0.2).abs() < 0.1,
            "{nm} {held_nm}"
        );
    }
    assert!(left_s < LOOSE_S);
    assert_eq!(
        askew_nm(LOOSE_S, 0.5).0,
        askew_nm(0.0, 0.5).0,
        "it still moves"
    );
}
