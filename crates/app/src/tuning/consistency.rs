//! Checks that settings fit each other.

use super::Refusal;
use crate::domain::{
    ImuCalibration, JointConfig, MagCalibration, MountingConfig, NO_CHANNEL, Orientation,
    RemoteChannel, RemoteMapping, RobotConfig, SafetyConfig,
};

/// Smallest distance between a joint's two soft limits.
const LEAST_TRAVEL_RAD: f32 = 0.01;
/// Smallest distance between a channel's centre and its ends, in counts. With less, a stick would jump.
const LEAST_SPAN: u32 = 200;

#[inline(never)]
pub fn check(config: &RobotConfig) -> Result<(), Refusal> {
    let fits = config.joints.iter().all(joint_can_move)
        && battery_limits_in_order(&config.safety)
        && preserves_directions(&config.mag)
        && config.radio.all().into_iter().all(ends_in_order)
        && each_channel_once(&config.radio);
    if fits {
        Ok(())
    } else {
        Err(Refusal::Inconsistent)
    }
}

/// Checks a change of mounting. Calibrations are in the robot's axes. One measured with other axes would correct the
/// wrong ones, so it must be cleared before its sensor is reoriented.
pub fn check_reorientation(now: &RobotConfig, wanted: &RobotConfig) -> Result<(), Refusal> {
    let (old, new) = (&now.mounting, &wanted.mounting);
    let reorients_imu = old.board != new.board;
    let reorients_mag = reorients_imu || mag_axes(old) != mag_axes(new);
    let invalidates_imu = reorients_imu && wanted.imu != ImuCalibration::default();
    let invalidates_mag = reorients_mag && wanted.mag != MagCalibration::default();
    if invalidates_imu || invalidates_mag {
        Err(Refusal::Calibrated)
    } else {
        Ok(())
    }
}

/// While the mounting is unknown, the magnetometer is shown in these axes.
fn mag_axes(mounting: &MountingConfig) -> Orientation {
    mounting.mag.unwrap_or_default()
}

fn joint_can_move(joint: &JointConfig) -> bool {
    joint.max_rad - joint.min_rad >= LEAST_TRAVEL_RAD
}

fn ends_in_order(channel: &RemoteChannel) -> bool {
    let span = |low: u32, high: u32| high.saturating_sub(low) >= LEAST_SPAN;
    span(channel.low, channel.centre) && span(channel.centre, channel.high)
}

fn each_channel_once(radio: &RemoteMapping) -> bool {
    let mut taken: u32 = 0;
    radio.all().into_iter().all(|channel| {
        let bit = 1u32.wrapping_shl(channel.index);
        let is_free = channel.index == NO_CHANNEL || taken & bit == 0;
        taken |= bit;
        is_free
    })
}

/// A low limit of 0 disables both, whatever the other value is.
fn battery_limits_in_order(safety: &SafetyConfig) -> bool {
    safety.battery_low_v == 0.0 || safety.battery_empty_v <= safety.battery_low_v
}

/// Whether the soft-iron matrix is positive definite, by its leading minors, so that no direction of the field
/// vanishes or is reversed.
fn preserves_directions(mag: &MagCalibration) -> bool {
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
    fn the_defaults_are_consistent() {
        assert_eq!(check(&RobotConfig::default()), Ok(()));
    }

    #[test]
    fn a_joint_needs_travel_between_its_limits() {
        assert!(refused(
            |config| config.joints[3].max_rad = config.joints[3].min_rad
        ));
        assert!(refused(|config| config.joints[0].min_rad = 2.0));
    }

    #[test]
    fn a_channel_needs_travel_on_both_sides_of_its_centre() {
        assert!(!refused(|config| config.radio.drive.low = 792));
        assert!(refused(|config| config.radio.drive.low = 793));
        assert!(!refused(|config| config.radio.e_stop.high = 1192));
        assert!(refused(|config| config.radio.e_stop.high = 1191));
        assert!(refused(|config| config.radio.steering.centre = 2047));
    }

    #[test]
    fn two_functions_do_not_share_a_channel() {
        assert!(refused(|config| config.radio.drive.index = 6));
        assert!(refused(|config| config.radio.e_stop.index = 0));
        assert!(!refused(|config| config.radio.e_stop.index = 15));
        assert!(!refused(|config| {
            config.radio.select.index = NO_CHANNEL;
            config.radio.dead_man.index = NO_CHANNEL;
        }));
    }

    #[test]
    fn the_empty_limit_must_not_exceed_the_low_limit() {
        assert!(refused(|config| config.safety.battery_empty_v = 21.5));
        assert!(refused(|config| config.safety.battery_low_v = 18.9));
        assert!(!refused(|config| config.safety.battery_low_v = 0.0));
    }

    /// Applies `change` to a robot that was calibrated by `calibrate`.
    fn turned(
        calibrate: impl Fn(&mut RobotConfig),
        change: impl FnOnce(&mut RobotConfig),
    ) -> Result<(), Refusal> {
        let mut now = RobotConfig::default();
        calibrate(&mut now);
        let mut wanted = now;
        change(&mut wanted);
        check_reorientation(&now, &wanted)
    }

    #[test]
    fn a_calibrated_sensor_is_not_reoriented() {
        let nothing = |_: &mut RobotConfig| ();
        let imu = |config: &mut RobotConfig| config.imu.accel_bias_mps2[1] = 0.1;
        let mag = |config: &mut RobotConfig| config.mag.bias_ut[2] = 30.0;
        let board = |config: &mut RobotConfig| config.mounting.board = Orientation::XLeftZUp;
        let mag_turned =
            |config: &mut RobotConfig| config.mounting.mag = Some(Orientation::XLeftZUp);
        let refused = Err(Refusal::Calibrated);
        assert_eq!(turned(nothing, board), Ok(()));
        assert_eq!(turned(nothing, mag_turned), Ok(()));
        assert_eq!(turned(imu, board), refused);
        assert_eq!(turned(imu, mag_turned), Ok(()));
        assert_eq!(turned(mag, board), refused);
        assert_eq!(turned(mag, mag_turned), refused);
        // The magnetometer was shown as if mounted like this, so its calibration stays valid.
        let as_shown =
            |config: &mut RobotConfig| config.mounting.mag = Some(Orientation::XForwardZUp);
        assert_eq!(turned(mag, as_shown), Ok(()));
        // A new calibration may be set, and an old one may be cleared together with the change.
        assert_eq!(turned(imu, mag), Ok(()));
        let all = |config: &mut RobotConfig| *config = RobotConfig::default();
        assert_eq!(turned(|config| (imu(config), board(config)).1, all), Ok(()));
    }

    #[test]
    fn a_mirroring_soft_iron_matrix_is_refused() {
        let set_xy = |config: &mut RobotConfig, value| {
            config.mag.soft_iron[0][1] = value;
            config.mag.soft_iron[1][0] = value;
        };
        assert!(!refused(|config| set_xy(config, 0.9)));
        assert!(refused(|config| set_xy(config, 1.0)));
        assert!(refused(|config| {
            config.mag.soft_iron = [[1.0, 0.8, 0.8], [0.8, 1.0, -0.8], [0.8, -0.8, 1.0]];
        }));
        // This matrix mirrors: the determinant is 0.05 − 0.125, although its leading parts and each pair of axes with
        // y are fine.
        assert!(refused(|config| {
            config.mag.soft_iron = [[1.0, 0.0, 0.5], [0.0, 0.5, 0.0], [0.5, 0.0, 0.1]];
        }));
        // 0.5 · 0.1 − 0.2² = 0.01 about each axis, the smallest stretch that is still allowed.
        for [x, y, z] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            let of_pair = |shear: f32| {
                let mut matrix = [[0.0; 3]; 3];
                matrix[x][x] = 1.0;
                matrix[y][y] = 0.5;
                matrix[z][z] = 0.1;
                matrix[y][z] = shear;
                matrix[z][y] = shear;
                matrix
            };
            assert!(!refused(|config| config.mag.soft_iron = of_pair(0.2)));
            assert!(!refused(|config| config.mag.soft_iron = of_pair(-0.2)));
            assert!(refused(|config| config.mag.soft_iron = of_pair(0.24)));
            assert!(refused(|config| config.mag.soft_iron = of_pair(-0.24)));
        }
        // 1 · (1 − 0.25) − 0.5 · (0.5 − 0.25 s) + 0.5 s · (0.25 − 0.5 s) is 0.5 for s = 1 and 0 for s = −1.
        let all = |sign: f32| {
            [
                [1.0, 0.5, 0.5 * sign],
                [0.5, 1.0, 0.5],
                [0.5 * sign, 0.5, 1.0],
            ]
        };
        assert!(!refused(|config| config.mag.soft_iron = all(1.0)));
        assert!(refused(|config| config.mag.soft_iron = all(-1.0)));
        // Two axes are mirrored, which the determinant of 0.25 does not show.
        assert!(refused(|config| {
            config.mag.soft_iron = [[0.5, 1.0, 1.0], [1.0, 0.5, 1.0], [1.0, 1.0, 1.0]];
        }));
    }
}
