//! Wheel odometry: the forward speed that each wheel shows by itself.

use super::{axes::Axes, axle::AxlePath, velocity_filter::MAX_SPEED_MPS};
use crate::domain::{MotorFeedback, WheelFeedback, WheelOdomConfig};

/// Feedback older than this is not used.
const MAX_AGE_US: u32 = 50_000;
/// A rotor slower than this stands. It covers noise and one unit of the report.
const STANDING_RPM: u16 = 20;

/// A speed in m/s by the left and the right wheel. `None` for a wheel that is silent, repeats an old report or does not
/// touch the ground.
pub(super) type PerWheel = [Option<f32>; 2];

/// Converts rotor speeds into forward speeds.
#[derive(Clone, Copy, Debug)]
pub(super) struct WheelSpeeds {
    /// Ground speed at one rotor revolution a minute, forward positive: left, right.
    mps_per_rpm: [f32; 2],
    radius_m: f32,
    /// Distance from the middle of the axle to each contact point, left positive.
    lever_m: [f32; 2],
}

impl WheelSpeeds {
    pub fn new(config: &WheelOdomConfig) -> Self {
        let half_track_m = 0.5 * config.wheel_track_m;
        let mps_per_rpm = config.mps_per_rpm();
        Self {
            mps_per_rpm: config.rpm_signs().map(|sign| sign * mps_per_rpm),
            radius_m: config.wheel_radius_m,
            lever_m: [half_track_m, -half_track_m],
        }
    }

    /// The forward speed of the estimated point by each wheel, if it rolls without slip. Without legs the point is the
    /// middle of the axle.
    ///
    /// The rotor's speed is measured against the motor, which pitches with the body, or with the shank that carries it. A
    /// wheel at a distance l to the left runs slower than the middle by yaw rate · l.
    pub fn forward_speeds(
        &self,
        motor: &MotorFeedback,
        axes: &Axes,
        legs: Option<&[AxlePath; 2]>,
    ) -> PerWheel {
        if !axes.is_upright() {
            return [None; 2];
        }
        let (yaw_rps, motor_mps) = (axes.yaw_rps(), axes.pitch_rps() * self.radius_m);
        let over_axle_mps = match legs {
            Some(legs) => legs
                .each_ref()
                .map(|leg| leg.carrier_rps * self.radius_m + axes.forward_over_axle(leg)),
            None => [0.0; 2],
        };
        let [left, right] = &motor.wheels;
        let [left_scale, right_scale] = self.mps_per_rpm;
        let [left_lever_m, right_lever_m] = self.lever_m;
        let [left_over_mps, right_over_mps] = over_axle_mps;
        [
            (left, left_scale, left_lever_m, left_over_mps),
            (right, right_scale, right_lever_m, right_over_mps),
        ]
        .map(|(wheel, mps_per_rpm, lever_m, over_mps)| {
            let axle_mps = f32::from(wheel.rpm) * mps_per_rpm + motor_mps + yaw_rps * lever_m;
            let speed_mps = axle_mps + over_mps;
            // Also false if a setting is not a number.
            let valid =
                wheel.age_us <= MAX_AGE_US && !wheel.frozen && speed_mps.abs() <= MAX_SPEED_MPS;
            valid.then_some(speed_mps)
        })
    }

    /// Mean speed in m/s of those wheels that have a value in `speeds`, against their motors.
    pub fn rolling_mps(&self, motor: &MotorFeedback, speeds: PerWheel) -> f32 {
        let [left, right] = &motor.wheels;
        let [left_scale, right_scale] = self.mps_per_rpm;
        let [left_speed, right_speed] = speeds;
        let rolling = [
            left_speed.map(|_| f32::from(left.rpm) * left_scale),
            right_speed.map(|_| f32::from(right.rpm) * right_scale),
        ];
        mean(rolling).unwrap_or(0.0)
    }
}

/// True if a rotor turns whose feedback is not too old.
pub(super) fn any_turns(motor: &MotorFeedback) -> bool {
    let turns = |wheel: &WheelFeedback| {
        wheel.age_us <= MAX_AGE_US && wheel.rpm.unsigned_abs() > STANDING_RPM
    };
    motor.wheels.iter().any(turns)
}

/// Mean of the wheels that have a value.
pub(super) fn mean(speeds: PerWheel) -> Option<f32> {
    match speeds {
        [Some(left), Some(right)] => Some(0.5 * (left + right)),
        [one, other] => one.or(other),
    }
}
