//! What each wheel by itself says about the forward speed of the robot.

use super::{axes::Axes, velocity_filter::MAX_SPEED_MPS};
use crate::domain::{MotorFeedback, WheelFeedback, WheelOdomConfig};

/// Feedback older than this says nothing about the speed now.
const MAX_AGE_US: u32 = 50_000;
/// A rotor slower than this stands: noise and one unit of its report.
const STANDING_RPM: u16 = 20;

/// Of the middle of the axle in m/s, by the left and the right wheel; none from a wheel that is silent, repeats an old
/// report or does not touch the ground.
pub(super) type ForwardSpeeds = [Option<f32>; 2];

#[derive(Clone, Copy, Debug)]
pub(super) struct WheelSpeeds {
    /// Rim speed of one rotor revolution a minute, forward positive: left, right.
    mps_per_rpm: [f32; 2],
    radius_m: f32,
    /// From the middle of the axle to each contact point, left positive.
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

    /// Rolling without slip: the wheel's own turn is that of its rotor against the motor plus that of the motor, which
    /// pitches with the body; a wheel at distance l to the left runs slower by yaw rate · l than the middle.
    pub fn forward_speeds(&self, motor: &MotorFeedback, axes: &Axes) -> ForwardSpeeds {
        if !axes.upright() {
            return [None; 2];
        }
        let (yaw_rps, motor_mps) = (axes.yaw_rps(), axes.pitch_rps() * self.radius_m);
        let [left, right] = &motor.wheels;
        let [left_scale, right_scale] = self.mps_per_rpm;
        let [left_lever_m, right_lever_m] = self.lever_m;
        [
            (left, left_scale, left_lever_m),
            (right, right_scale, right_lever_m),
        ]
        .map(|(wheel, mps_per_rpm, lever_m)| {
            let speed_mps = f32::from(wheel.rpm) * mps_per_rpm + motor_mps + yaw_rps * lever_m;
            // Settings that are no numbers end here.
            let counts =
                wheel.age_us <= MAX_AGE_US && !wheel.frozen && speed_mps.abs() <= MAX_SPEED_MPS;
            counts.then_some(speed_mps)
        })
    }
}

/// True if a rotor that is heard turns.
pub(super) fn any_turns(motor: &MotorFeedback) -> bool {
    let turns = |wheel: &WheelFeedback| {
        wheel.age_us <= MAX_AGE_US && wheel.rpm.unsigned_abs() > STANDING_RPM
    };
    motor.wheels.iter().any(turns)
}

/// Of those that say something.
pub(super) fn mean(speeds: ForwardSpeeds) -> Option<f32> {
    match speeds {
        [Some(left), Some(right)] => Some(0.5 * (left + right)),
        [one, other] => one.or(other),
    }
}
