//! Dry friction of the wheels' gears and of the hips. It would hold a robot that leans a little, and let it go with a jerk.

use crate::math::scalar;

/// Dry friction in N·m that is made up for. An M3508 without load takes 0.23 N·m, of which a part grows with speed; how it is
/// split is assumed (docs/hardware.md). More than the dry part would drive a wheel by itself.
const DRY_NM: f32 = 0.12;
/// Speed of a gear in rad/s from which on all of it counts. One step of the reported speed is 0.005.
const FULL_RPS: f32 = 0.1;

/// Torques of the wheels' motors in N·m that leave `wheels_nm` behind gears that turn at `gear_rps`. They are within
/// ±`limit_nm`.
pub fn overcome(wheels_nm: [f32; 2], gear_rps: [f32; 2], limit_nm: f32) -> [f32; 2] {
    let [left_nm, right_nm] = wheels_nm;
    let [left_rps, right_rps] = gear_rps;
    let overcome = |nm: f32, rps: f32| {
        let friction_nm = scalar::clamp(rps * (DRY_NM / FULL_RPS), -DRY_NM, DRY_NM);
        scalar::clamp(nm + friction_nm, -limit_nm, limit_nm)
    };
    [overcome(left_nm, left_rps), overcome(right_nm, right_rps)]
}

/// Dry friction in N·m of a leg's two hip joints that is made up for, of some 0.3. All of it would let the body sway for ever.
const HIPS_DRY_NM: f32 = 0.2;

/// Torque in N·m of the body on a leg that leaves `lean_nm` behind the friction of its hips. They need not turn for it: it is
/// added the way they shall turn.
pub fn loosened(lean_nm: f32) -> f32 {
    lean_nm + scalar::clamp(lean_nm, -HIPS_DRY_NM, HIPS_DRY_NM)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gear_that_turns_gets_its_friction_on_top() {
        assert_eq!(overcome([0.0; 2], [2.0, -2.0], 4.5), [DRY_NM, -DRY_NM]);
        assert_eq!(overcome([1.0; 2], [0.0, -9.0], 4.5), [1.0, 1.0 - DRY_NM]);
    }

    #[test]
    fn it_begins_without_a_step() {
        let [slow_nm, slower_nm] = overcome([0.0; 2], [0.05, 0.005], 4.5);
        assert!((slow_nm - 0.06).abs() < 1e-6 && (slower_nm - 0.006).abs() < 1e-6);
    }

    #[test]
    fn hips_get_their_friction_the_way_they_shall_turn() {
        assert_eq!([0.0, 0.1, -3.0].map(loosened), [0.0, 0.2, -3.2]);
    }

    #[test]
    fn the_limit_holds() {
        assert_eq!(overcome([4.5, -4.5], [3.0, -3.0], 4.5), [4.5, -4.5]);
    }
}
