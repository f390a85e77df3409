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

/// Time in s after which a robot flies that falls freely, and whose wheels suddenly roll at this speed in m/s.
fn flies_after_s(speed_mps: f32) -> f32 {
    const TICK_S: f32 = 0.001;
    let mut law = Law::new(&FIVEBAR.balance, &Measured::at_rest());
    let radius_m = FIVEBAR.wheel_odom.wheel_radius_m;
    let measured = Measured {
        speed_mps,
        ground_mps: speed_mps,
        up_mps2: 0.0,
        wheel_rps: [speed_mps / radius_m; 2],
        ..Measured::at_rest()
    };
    let goal = Goal {
        stop: true,
        ground: Ground::Felt,
        ..Goal::upright(Ramp::at(0.2))
    };
    let mut lasts_s = 0.0;
    while !law.airborne() {
        law.step(
            &FIVEBAR.balance,
            &FIVEBAR.wheel_odom,
            &measured,
            &goal,
            TICK_S,
        );
        lasts_s += TICK_S;
        assert!(lasts_s < 1.0);
    }
    lasts_s
}

#[test]
fn legs_of_a_pushed_robot_may_push_nothing_for_a_moment() {
    assert!(flies_after_s(0.0) < 0.03, "{}", flies_after_s(0.0));
    for speed_mps in [0.8, -0.8] {
        let seconds = flies_after_s(speed_mps);
        assert!((0.2..0.25).contains(&seconds), "{seconds}");
    }
}
