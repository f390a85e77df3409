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
