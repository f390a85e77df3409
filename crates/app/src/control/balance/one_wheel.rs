//! One wheel in the air: the other one carries and balances the robot.

use super::{measured::Measured, support::Support, virtual_leg::LegForce};
use crate::{domain::BalanceProfile, math::scalar};

/// Damping of the lifted wheel about the turn of the other one in N·m·s/rad.
const WHEEL_DAMPING: f32 = 0.05;
/// Stiffness and damping of the lifted leg about the lean of the other one in N·m/rad and N·m·s/rad.
const NM_PER_RAD: f32 = 12.0;
const NMS_PER_RAD: f32 = 0.6;

/// Wheel torques in N·m and forces of the legs, left and right.
pub type Both = ([f32; 2], [LegForce; 2]);

/// What both sides should do becomes what the side on the ground does. The other one follows it, with its wheel where
/// level ground would be.
pub fn carry(
    (wheels_nm, legs): Both,
    left_is_lifted: bool,
    profile: &BalanceProfile,
    track_m: f32,
    measured: &Measured,
) -> Both {
    let [left_nm, right_nm] = wheels_nm;
    let [left, right] = legs;
    let limit_nm = profile.limits.wheel_nm;
    let both_nm = scalar::clamp(left_nm + right_nm, -limit_nm, limit_nm);
    let both = LegForce {
        push_n: left.push_n + right.push_n,
        lean_nm: left.lean_nm + right.lean_nm,
    };
    let [left_rps, right_rps] = measured.wheel_rps;
    let wheel_nm = WHEEL_DAMPING * (right_rps - left_rps);
    let ([left_lean, right_lean], [left_rate, right_rate]) = (measured.lean_rad, measured.lean_rps);
    let lean_nm = NM_PER_RAD * (right_lean - left_lean) + NMS_PER_RAD * (right_rate - left_rate);
    let [left_n, right_n] = Support::one_in_air(&profile.mass, track_m, measured);
    if left_is_lifted {
        let follows = LegForce {
            push_n: left_n,
            lean_nm,
        };
        ([wheel_nm, both_nm], [follows, both])
    } else {
        let follows = LegForce {
            push_n: right_n,
            lean_nm: -lean_nm,
        };
        ([both_nm, -wheel_nm], [both, follows])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{control::balance::tilt::Tilt, domain::robots::FIVEBAR};

    const WHEELS_NM: [f32; 2] = [0.4, -0.1];
    const LEGS: [LegForce; 2] = [
        LegForce {
            push_n: 20.0,
            lean_nm: 0.5,
        },
        LegForce {
            push_n: 30.0,
            lean_nm: -0.2,
        },
    ];

    /// A robot whose left side differs from its right one in everything.
    fn aslant() -> Measured {
        let rest = Measured::at_rest();
        let [mut left, right] = rest.legs;
        left.length_m += 0.01;
        left.length_mps = 0.2;
        Measured {
            tilt: Tilt {
                roll_rad: 0.05,
                ..rest.tilt
            },
            legs: [left, right],
            lean_rad: [0.1, 0.15],
            lean_rps: [0.2, 0.5],
            wheel_rps: [3.0, 7.0],
            ..rest
        }
    }

    fn mirrored(mut measured: Measured) -> Measured {
        measured.legs.reverse();
        measured.lean_rad.reverse();
        measured.lean_rps.reverse();
        measured.wheel_rps.reverse();
        measured.tilt.roll_rad = -measured.tilt.roll_rad;
        measured
    }

    fn carried(left_is_lifted: bool, (wheels_nm, legs): Both, measured: &Measured) -> Both {
        let track_m = FIVEBAR.wheel_odom.wheel_track_m;
        let profile = &FIVEBAR.balance;
        carry(
            (wheels_nm, legs),
            left_is_lifted,
            profile,
            track_m,
            measured,
        )
    }

    #[test]
    fn both_sides_are_mirror_images() {
        let (mut wheels_nm, mut legs) = carried(true, (WHEELS_NM, LEGS), &aslant());
        wheels_nm.reverse();
        legs.reverse();
        let ([left_nm, right_nm], [left, right]) = (WHEELS_NM, LEGS);
        let both = ([right_nm, left_nm], [right, left]);
        let found = carried(false, both, &mirrored(aslant()));
        assert_eq!(found, (wheels_nm, legs));
    }

    #[test]
    fn the_side_in_the_air_follows_the_one_that_does_what_both_should() {
        let (wheels_nm, legs) = carried(true, (WHEELS_NM, LEGS), &aslant());
        let ([follower_nm, carrier_nm], [follower, carrier]) = (wheels_nm, legs);
        assert!((carrier_nm - 0.3).abs() < 1e-6);
        assert_eq!(carrier.push_n, 50.0);
        assert!((carrier.lean_nm - 0.3).abs() < 1e-6);
        // The right wheel turns faster, and the right leg leans further.
        assert!(follower_nm > 0.0 && follower.lean_nm > 0.0);
        let mut slower = aslant();
        slower.lean_rad.reverse();
        slower.lean_rps.reverse();
        slower.wheel_rps.reverse();
        let ([follower_nm, _], [follower, _]) = carried(true, (WHEELS_NM, LEGS), &slower);
        assert!(follower_nm < 0.0 && follower.lean_nm < 0.0);
    }
}
