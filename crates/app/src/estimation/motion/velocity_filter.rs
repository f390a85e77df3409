//! Velocity and the accelerometer's offset, a Kalman filter with fixed gains.
//!
//! Along each of the level axes (forward, left, up), with a the acceleration without gravity, b its offset, v the speed
//! and y what is observed of it:
//!
//! v̇ = a − b + w, ḃ = u, y = v + n
//!
//! with white noise w, u, n of densities q, p, r. Setting the derivative of the covariance in the Riccati equation to
//! zero gives the gains on y − v (R. E. Kalman, R. S. Bucy, "New results in linear filtering and prediction theory",
//! 1961; solved by hand for these two states):
//!
//! k = √(q/r + 2·√(p/r)) for v, −h = −√(p/r) for b
//!
//! q: an acceleration error of 0.3 m/s² that is another one in each sample, q = 0.3² · 0.005 s: vibration.
//! p: the horizon wanders after each start and stop, which looks like an offset.
//! r: an error of σ that lasts for τ has the density 2·σ²·τ.

use super::axes::Axes;
use crate::math::{Vector3, scalar, vector};

const GRAVITY_MPS2: f32 = 9.806_65;
/// No robot with these wheels moves faster.
pub(super) const MAX_SPEED_MPS: f32 = 20.0;
/// Zero-g offset of the BMI088 over life (datasheet: ±20 mg, board mounting adds to it), and what the horizon may be off.
const MAX_BIAS_MPS2: f32 = 0.6;
/// Offset kept of one that is larger.
const BACK_TO_LIMIT: f32 = 0.99;
/// More than this at once is taken for this much: it is no noise the gains were made for.
const MAX_INNOVATION_MPS: f32 = 0.5;
/// A sample for longer than this corrects no more than one for this long.
const MAX_CORRECTION_S: f32 = 0.01;
/// Standing still brings the speed to zero with this time constant …
const STILL_S: f32 = 0.05;
/// … and the offset to what is felt with this one.
const STILL_BIAS_S: f32 = 1.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Gains {
    /// k in 1/s.
    pub speed: f32,
    /// h in 1/s².
    pub bias: f32,
}

/// Wheels: σ = 0.03 m/s for τ = 0.05 s (tyres creep by a few per cent, gears have play); p = (0.05 m/s²)²/s.
pub(super) const FORWARD: Gains = Gains {
    speed: 3.942,
    bias: 5.270,
};
/// Wheels do not roll sideways, but skid: σ = 0.05 m/s for τ = 0.2 s; p as above.
pub(super) const LEFT: Gains = Gains {
    speed: 1.901,
    bias: 1.581,
};
/// The body rises and falls with the legs and comes back: σ = 0.05 m/s for τ = 0.2 s; p = (0.01 m/s²)²/s.
pub(super) const UP: Gains = Gains {
    speed: 1.040,
    bias: 0.3162,
};

/// An IMU this far from the middle of the axle feels LEVER_M · yaw rate² for as long as the robot turns …
const LEVER_M: f32 = 0.05;
/// … which the gains of speed rise against, so that it makes no more than this …
const LEVER_MPS: f32 = 0.05;
/// … up to this gain (7 rad/s), …
const MAX_LEVER_GAIN: f32 = 50.0;
/// … and which counts as offset only as far as it is small against this, the zero-g offset of the BMI088 (20 mg).
const BIAS_MPS2: f32 = 0.2;

#[derive(Clone, Copy, Debug)]
pub(super) struct VelocityFilter {
    /// World frame, at the last sample.
    velocity_mps: Vector3,
    /// World frame, without gravity and offset, since the last sample.
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

    /// Of a specific force: what accelerates the body, in its own axes.
    pub fn free_accel(&self, felt_mps2: Vector3, axes: &Axes) -> Vector3 {
        vector::sub(felt_mps2, self.force_at_constant_speed(axes))
    }

    /// What an IMU feels that nothing accelerates, in body axes.
    pub fn force_at_constant_speed(&self, axes: &Axes) -> Vector3 {
        let gravity = vector::scale(axes.up_in_body(), GRAVITY_MPS2);
        vector::add(self.accel_bias_mps2, gravity)
    }

    /// `free_mps2`: body axes, over the last `dt_s`.
    pub fn predict(&mut self, free_mps2: Vector3, axes: &Axes, dt_s: f32) {
        self.accel_mps2 = axes.to_world(free_mps2);
        self.velocity_mps = self.velocity_after(dt_s);
    }

    /// `innovation_mps`: what is observed less what the filter believes, forward, left and up. The acceleration that the
    /// change of velocity amounts to, in body axes.
    pub fn correct(
        &mut self,
        innovation_mps: Vector3,
        axes: &Axes,
        dt_s: f32,
        learning: bool,
    ) -> Vector3 {
        let [forward, left, up] = plausible(innovation_mps);
        let dt_s = scalar::min(dt_s, MAX_CORRECTION_S);
        let lever_mps2 = LEVER_M * axes.yaw_rps() * axes.yaw_rps();
        let lever = scalar::min(lever_mps2 / LEVER_MPS, MAX_LEVER_GAIN);
        let gained = [
            (FORWARD.speed + lever) * forward,
            (LEFT.speed + lever) * left,
            UP.speed * up,
        ];
        let gained_mps2 = axes.flat_to_world(gained);
        self.shift(vector::scale(gained_mps2, dt_s));
        if learning {
            let odds = lever_mps2 / BIAS_MPS2;
            let learning_s = dt_s / (1.0 + odds * odds);
            let bias = [FORWARD.bias * forward, LEFT.bias * left, UP.bias * up];
            let bias = axes.to_body(axes.flat_to_world(bias));
            self.accel_bias_mps2 =
                vector::sub(self.accel_bias_mps2, vector::scale(bias, learning_s));
        }
        axes.to_body(gained_mps2)
    }

    pub fn shift(&mut self, by_mps: Vector3) {
        self.velocity_mps = vector::add(self.velocity_mps, by_mps);
    }

    /// Gives up `share` of the velocity, and the acceleration.
    pub fn leak(&mut self, share: f32) {
        let kept = scalar::max(1.0 - share, 0.0);
        self.velocity_mps = vector::scale(self.velocity_mps, kept);
        self.accel_mps2 = [0.0; 3];
    }

    /// The body stands.
    pub fn stop(&mut self, dt_s: f32) {
        self.leak(dt_s / STILL_S);
    }

    /// The body stands: what accelerates it is nothing but offset.
    pub fn hold_still(&mut self, free_mps2: Vector3, dt_s: f32) {
        self.stop(dt_s);
        let share = scalar::min(dt_s / STILL_BIAS_S, 1.0);
        self.accel_bias_mps2 = vector::add(self.accel_bias_mps2, vector::scale(free_mps2, share));
    }

    /// Starts over with a speed that no robot has; keeps the offset within its limit.
    pub fn stay_plausible(&mut self) {
        let speed = vector::dot(self.velocity_mps, self.velocity_mps);
        let bias = vector::dot(self.accel_bias_mps2, self.accel_bias_mps2);
        if bias > MAX_BIAS_MPS2 * MAX_BIAS_MPS2 {
            self.accel_bias_mps2 = vector::scale(self.accel_bias_mps2, BACK_TO_LIMIT);
        }
        let possible = speed <= MAX_SPEED_MPS * MAX_SPEED_MPS;
        if !possible {
            *self = Self::new();
        }
    }

    /// World frame, `ahead_s` after the last sample.
    pub fn velocity_after(&self, ahead_s: f32) -> Vector3 {
        vector::add(self.velocity_mps, vector::scale(self.accel_mps2, ahead_s))
    }

    /// Body axes.
    pub const fn accel_bias_mps2(&self) -> Vector3 {
        self.accel_bias_mps2
    }
}

/// No longer than an innovation may be.
fn plausible(innovation_mps: Vector3) -> Vector3 {
    let squared = vector::dot(innovation_mps, innovation_mps);
    if squared <= MAX_INNOVATION_MPS * MAX_INNOVATION_MPS {
        return innovation_mps;
    }
    let inverse = scalar::inverse_sqrt(squared);
    vector::scale(innovation_mps, MAX_INNOVATION_MPS * inverse)
}
