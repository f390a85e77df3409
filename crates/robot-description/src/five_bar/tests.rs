use super::*;

const SMALL: FiveBar = FiveBar {
    half_gap_m: 0.05,
    thigh_m: 0.12,
    shank_m: 0.22,
};
const LARGE: FiveBar = FiveBar {
    half_gap_m: 0.075,
    thigh_m: 0.15,
    shank_m: 0.27,
};

/// Jacobians by differences in NumPy, from intersecting the two circles about the knees.
#[test]
fn torque_per_newton_is_that_of_a_numerical_jacobian() {
    for (leg, length_m, expected) in [
        (SMALL, 0.11, 0.0369),
        (SMALL, 0.14, 0.0602),
        (SMALL, 0.18, 0.0770),
        (SMALL, 0.22, 0.0813),
        (SMALL, 0.30, 0.0564),
        (LARGE, 0.12, 0.0477),
        (LARGE, 0.18, 0.0935),
        (LARGE, 0.26, 0.1085),
        (LARGE, 0.36, 0.0775),
    ] {
        let found = leg.torque_per_newton(length_m).expect("in reach");
        assert!((found - expected).abs() < 5e-5, "{length_m}: {found}");
    }
}

#[test]
fn hips_are_where_circles_meet() {
    for (leg, length_m, lean_rad, expected) in [
        (SMALL, 0.18, 0.0, [-0.291, 0.291]),
        (SMALL, 0.30, 0.0, [-1.095, 1.095]),
        (LARGE, 0.12, 0.0, [0.239, -0.239]),
    ] {
        let found = leg.hips_rad(length_m, lean_rad).expect("in reach");
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 5e-4, "{length_m}: {found}");
        }
    }
    assert_eq!(SMALL.hips_rad(0.34, 0.0), None);
}

/// A leg that leans forward is one that leans backward, seen from the other side.
#[test]
fn leaning_legs_mirror_each_other() {
    let [front, rear] = SMALL.hips_rad(0.2, 0.5).expect("in reach");
    let [front_back, rear_back] = SMALL.hips_rad(0.2, -0.5).expect("in reach");
    assert!((front + rear_back).abs() < 1e-12 && (rear + front_back).abs() < 1e-12);
    assert!(front > -0.2, "forward is up at the front: {front}");
}

/// Sines from the same NumPy program: 0.849 at the knees and 0.992 between the shanks.
#[test]
fn margins_of_a_standing_leg() {
    let hips = SMALL.hips_rad(0.18, 0.0).expect("in reach");
    let margins = SMALL.margins(hips).expect("closed");
    assert!(
        (margins.at_knee_rad.sin() - 0.849).abs() < 5e-4,
        "{margins:?}"
    );
    assert!((margins.between_shanks_rad.sin() - 0.992).abs() < 5e-4);
}

/// A thigh lies on its shank where half of the gap is the difference of the lengths times the cosine: at 60°.
#[test]
fn a_folded_leg_has_no_leverage() {
    let at_knee_rad = |up_rad| {
        SMALL
            .margins([up_rad, -up_rad])
            .expect("closed")
            .at_knee_rad
    };
    assert!(at_knee_rad(1.04) > 0.0);
    assert!(at_knee_rad(1.055) < 0.0);
}
