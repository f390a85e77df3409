use super::*;
use crate::domain::LegGeometry;

#[test]
fn wheels_balance_before_they_turn() {
    assert_eq!(within_wheels([1.0, 2.0], 2.4), [1.0, 2.0]);
    assert_eq!(within_wheels([2.0, 4.0], 2.4), [2.4, 2.4]);
    let [left, right] = within_wheels([1.0, 3.0], 2.4);
    assert!((left - 1.6).abs() < 1e-6 && (right - 2.4).abs() < 1e-6);
    assert_eq!(within_wheels([-9.0, -9.0], 2.4), [-2.4, -2.4]);
}

#[test]
fn hips_balance_before_they_carry() {
    let leg = Leg::new(&LegGeometry::EXAMPLE, [-0.3, 0.3], [0.0; 2]);
    let wanted = LegForce {
        push_n: 200.0,
        lean_nm: 6.0,
    };
    let free = within_hips(&leg, wanted, 0.0, 1000.0);
    assert_eq!(free, hip_torques_nm(&leg, wanted));
    let [front, rear] = within_hips(&leg, wanted, 0.0, 7.0);
    assert!(front.abs() <= 7.0 && rear.abs() <= 7.0);
    let found = super::super::virtual_leg::force_of(&leg, [front, rear]);
    assert!((found.lean_nm - 6.0).abs() < 1e-3, "{found:?}");
    assert!((30.0..150.0).contains(&found.push_n), "{found:?}");
}

#[test]
fn what_leans_a_leg_is_limited_too() {
    let leg = Leg::new(&LegGeometry::EXAMPLE, [-0.3, 0.3], [0.0; 2]);
    let wanted = LegForce {
        push_n: 50.0,
        lean_nm: 100.0,
    };
    let hips_nm = within_hips(&leg, wanted, 2.0, 7.0);
    assert_eq!(hips_nm, [-7.0, -7.0]);
}
