//! Velocity and accelerometer bias: a Kalman filter with stationary gains.
//!
//! Along each of the level axes (forward, left, up), with the measured acceleration a (without gravity), its bias b, the
//! speed v and its measurement y:
//!
//! v̇ = a − b + w, ḃ = u, y = v + n
//!
//! where w, u, n are white noise of the densities q, p, r. In the stationary state the derivative of the covariance is zero
//! in the Riccati equation (R. E. Kalman, R. S. Bucy, "New results in linear filtering and prediction theory", 1961). Solved
//! for these two states, that gives the gains on the innovation y − v:
//!
//! k = √(q/r + 2·√(p/r)) for v, −h = −√(p/r) for b
//!
//! q is vibration: an error of 0.3 m/s² that is independent in each sample, q = 0.3² · 0.005 s. p is the tilt error after
//! each start and stop, which looks like a bias. r comes from a measurement error of σ that lasts for τ: r = 2·σ²·τ.

use super::axes::Axes;
use crate::math::{Vector3, scalar, vector};

const GRAVITY_MPS2: f32 = 9.806_65;
/// Largest speed of a robot with these wheels.
pub(super) const MAX_SPEED_MPS: f32 = 20.0;
/// Limit of the bias: zero-g offset of the BMI088 (datasheet: ±20 mg, mounting on a board adds to it) and tilt error.
const MAX_BIAS_MPS2: f32 = 0.6;
/// Factor by which a larger bias shrinks in each sample.
const BIAS_SHRINK: f32 = 0.99;
/// An innovation is clipped to this. The gains are not made for a larger one.
const MAX_INNOVATION_MPS: f32 = 0.5;
/// A longer sample corrects no more than one of this length.
const MAX_UPDATE_S: f32 = 0.01;
/// Time constant of the velocity in a zero-velocity update.
const STANDSTILL_S: f32 = 0.05;
/// Time constant of the bias in a zero-velocity update.
const STANDSTILL_BIAS_S: f32 = 1.0;

/// Stationary Kalman gains of one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gains {
    /// k in 1/s.
    pub speed: f32,
    /// h in 1/s².
    pub bias: f32,
}

/// Wheel speed: σ = 0.03 m/s for τ = 0.05 s (tyres creep by a few per cent, gears have play), p = (0.05 m/s²)²/s.
pub(super) const FORWARD: Gains = Gains {
    speed: 3.942,
    bias: 5.270,
};
/// Wheels do not roll sideways, but creep: σ = 0.05 m/s for τ = 0.2 s, p as above.
pub(super) const LEFT: Gains = Gains {
    speed: 1.901,
    bias: 1.581,
};
/// The legs raise and lower the body: σ = 0.05 m/s for τ = 0.2 s, p = (0.01 m/s²)²/s.
pub(super) const UP: Gains = Gains {
    speed: 1.040,
    bias: 0.3162,
};

/// Lever arm from the middle of the axle to the IMU. While the robot turns, the IMU measures LEVER_M · yaw rate².
const LEVER_M: f32 = 0.05;
/// The speed gains rise against that, so that the velocity error stays below this.
const LEVER_MPS: f32 = 0.05;
/// Largest rise of the speed gains, reached at 7 rad/s.
const MAX_LEVER_GAIN: f32 = 50.0;
/// The bias is updated only as far as that acceleration is small against this, the zero-g offset of the BMI088 (20 mg).
const BIAS_MPS2: f32 = 0.2;

/// Velocity and accelerometer bias of all three axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct VelocityFilter {
    /// World frame, at the end of the last sample.
    velocity_mps: Vector3,
    /// World frame, without gravity and bias; it holds until the next sample.
    accel_mps2: Vector3,
    /// Body axes.
    accel_bias_mps2: Vector3,
}

impl VelocityFilter {
    pub const fn new() -> Self {
        Self {
            velocity_mps: [0.0; 3],
            accel_mps2: [0.0; 3],
            accel_bias_mps2: [0.0; 3],
        }
    }

    /// Specific force less gravity and bias, in body axes.
    pub fn free_accel(&self, force_mps2: Vector3, axes: &Axes) -> Vector3 {
        vector::sub(force_mps2, self.force_at_constant_speed(axes))
    }

    /// The specific force that the IMU measures at constant velocity: gravity and bias, in body axes.
    pub fn force_at_constant_speed(&self, axes: &Axes) -> Vector3 {
        let gravity = vector::scale(axes.up_in_body(), GRAVITY_MPS2);
        vector::add(self.accel_bias_mps2, gravity)
    }

    /// Prediction over the last `dt_s`. `free_mps2` is the free acceleration in body axes.
    pub fn predict(&mut self, free_mps2: Vector3, axes: &Axes, dt_s: f32) {
        self.accel_mps2 = axes.to_world(free_mps2);
        self.velocity_mps = self.velocity_after(dt_s);
    }

    /// Update with the innovation of the speeds forward, left and up. Returns the correction of the velocity as an
    /// acceleration in body axes.
    pub fn update(
        &mut self,
        innovation_mps: Vector3,
        axes: &Axes,
        dt_s: f32,
        update_bias: bool,
    ) -> Vector3 {
        let [forward, left, up] = clipped(innovation_mps);
        let dt_s = scalar::min(dt_s, MAX_UPDATE_S);
        let lever_mps2 = LEVER_M * axes.yaw_rps() * axes.yaw_rps();
        let lever = scalar::min(lever_mps2 / LEVER_MPS, MAX_LEVER_GAIN);
        let correction = [
            (FORWARD.speed + lever) * forward,
            (LEFT.speed + lever) * left,
            UP.speed * up,
        ];
        let correction_mps2 = axes.level_to_world(correction);
        self.shift(vector::scale(correction_mps2, dt_s));
        if update_bias {
            let ratio = lever_mps2 / BIAS_MPS2;
            let bias_dt_s = dt_s / (1.0 + ratio * ratio);
            let bias = [FORWARD.bias * forward, LEFT.bias * left, UP.bias * up];
            let bias = axes.to_body(axes.level_to_world(bias));
            self.accel_bias_mps2 =
                vector::sub(self.accel_bias_mps2, vector::scale(bias, bias_dt_s));
        }
        axes.to_body(correction_mps2)
    }

    /// Adds to the velocity, in the world frame.
    pub fn shift(&mut self, by_mps: Vector3) {
        self.velocity_mps = vector::add(self.velocity_mps, by_mps);
    }

    /// Reduces the velocity by `share`, and sets the acceleration to zero.
    pub fn decay(&mut self, share: f32) {
        let kept = scalar::max(1.0 - share, 0.0);
        self.velocity_mps = vector::scale(self.velocity_mps, kept);
        self.accel_mps2 = [0.0; 3];
    }

    /// Brings the velocity to zero at a standstill; the bias stays.
    pub fn stop(&mut self, dt_s: f32) {
        self.decay(dt_s / STANDSTILL_S);
    }

    /// Zero-velocity update: all of the free acceleration is an error of the bias. What is left of the velocity is
    /// `rest_mps`.
    pub fn zero_velocity_update(&mut self, free_mps2: Vector3, rest_mps: Vector3, dt_s: f32) {
        self.stop(dt_s);
        let share = scalar::min(dt_s / STANDSTILL_S, 1.0);
        self.shift(vector::scale(rest_mps, share));
        let share = scalar::min(dt_s / STANDSTILL_BIAS_S, 1.0);
        self.accel_bias_mps2 = vector::add(self.accel_bias_mps2, vector::scale(free_mps2, share));
    }

    /// Keeps the bias within its limit, and resets the filter at a speed that no robot has.
    pub fn limit(&mut self) {
        let speed = vector::dot(self.velocity_mps, self.velocity_mps);
        let bias = vector::dot(self.accel_bias_mps2, self.accel_bias_mps2);
        if bias > MAX_BIAS_MPS2 * MAX_BIAS_MPS2 {
            self.accel_bias_mps2 = vector::scale(self.accel_bias_mps2, BIAS_SHRINK);
        }
        let possible = speed <= MAX_SPEED_MPS * MAX_SPEED_MPS;
        if !possible {
            *self = Self::new();
        }
    }

    /// Velocity in the world frame, `ahead_s` after the last sample.
    pub fn velocity_after(&self, ahead_s: f32) -> Vector3 {
        vector::add(self.velocity_mps, vector::scale(self.accel_mps2, ahead_s))
    }

    /// Accelerometer bias in body axes.
    pub const fn accel_bias_mps2(&self) -> Vector3 {
        self.accel_bias_mps2
    }
}

/// Clips the length of the innovation.
fn clipped(innovation_mps: Vector3) -> Vector3 {
    let squared = vector::dot(innovation_mps, innovation_mps);
    if squared <= MAX_INNOVATION_MPS * MAX_INNOVATION_MPS {
        return innovation_mps;
    }
    let inverse = scalar::inverse_sqrt(squared);
    vector::scale(innovation_mps, MAX_INNOVATION_MPS * inverse)
}
