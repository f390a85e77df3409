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
