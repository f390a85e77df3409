//! Settings that must fit each other.

use super::Refusal;
use crate::domain::{JointConfig, MagCalibration, RobotConfig, SafetyConfig};

/// Least distance of a joint's two soft limits.
const LEAST_TRAVEL_RAD: f32 = 0.01;

#[inline(never)]
pub fn check(config: &RobotConfig) -> Result<(), Refusal> {
    let fits = config.joints.iter().all(joint_can_move)
        && battery_limits_in_order(&config.safety)
        && keeps_directions(&config.mag);
    if fits {
        Ok(())
    } else {
        Err(Refusal::Inconsistent)
    }
}

fn joint_can_move(joint: &JointConfig) -> bool {
    joint.max_rad - joint.min_rad >= LEAST_TRAVEL_RAD
}

/// Low 0 switches both off, whatever the other is.
fn battery_limits_in_order(safety: &SafetyConfig) -> bool {
    safety.battery_low_v == 0.0 || safety.battery_empty_v <= safety.battery_low_v
}

/// Positive definite, by its leading minors: no direction of the field vanishes or turns round.
fn keeps_directions(mag: &MagCalibration) -> bool {
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = mag.soft_iron;
    let minor = xx * yy - xy * xy;
    let determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    xx > 0.0 && minor > 0.0 && determinant > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: impl FnOnce(&mut RobotConfig)) -> bool {
        let mut config = RobotConfig::default();
        change(&mut config);
        check(&config) == Err(Refusal::Inconsistent)
    }

    #[test]
    fn the_default_fits() {
        assert_eq!(check(&RobotConfig::default()), Ok(()));
    }

    #[test]
    fn a_joint_needs_room_to_move() {
        assert!(refused(
            |config| config.joints[3].max_rad = config.joints[3].min_rad
        ));
        assert!(refused(|config| config.joints[0].min_rad = 2.0));
    }

    #[test]
    fn an_empty_battery_is_emptier_than_a_low_one() {
        assert!(refused(|config| config.safety.battery_empty_v = 21.5));
        assert!(refused(|config| config.safety.battery_low_v = 18.9));
        assert!(!refused(|config| config.safety.battery_low_v = 0.0));
    }

    #[test]
    fn a_soft_iron_matrix_that_mirrors_is_refused() {
        let set_xy = |config: &mut RobotConfig, value| {
            config.mag.soft_iron[0][1] = value;
            config.mag.soft_iron[1][0] = value;
        };
        assert!(!refused(|config| set_xy(config, 0.9)));
        assert!(refused(|config| set_xy(config, 1.0)));
        assert!(refused(|config| {
            config.mag.soft_iron = [[1.0, 0.8, 0.8], [0.8, 1.0, -0.8], [0.8, -0.8, 1.0]];
        }));
        // Two axes mirrored: the determinant, 0.25, does not show it.
        assert!(refused(|config| {
            config.mag.soft_iron = [[0.5, 1.0, 1.0], [1.0, 0.5, 1.0], [1.0, 1.0, 1.0]];
        }));
    }
}
