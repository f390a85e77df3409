//! The reward of a step.
//!
//! With the robot's speed v and the commanded v*, turn rate ω and ω*, roll φ, pitch θ, height h of the hip centre, wheel
//! torques τ, actions a and those before them a′ (6 values, clipped, not scaled):
//!
//! | term | value |
//! |---|---|
//! | speed | `2 · exp(−(v − v*)² / 0.06) − 0.3 · |v − v*|` |
//! | turn | `0.75 · exp(−(ω − ω*)² / 0.5)` |
//! | upright | `−2 · φ² − 0.5 · θ²` |
//! | height | `−10 · (h − 0.26 m)²` |
//! | shaking | `−0.02 · (a − a′)²`, summed over the joints |
//! | torque | `−0.01 · (τl² + τr²)` |
//! | alive | `0.5` |
//! | fall | `−10`, once |

use crate::Truth;

/// Height of the hip centre in m that is rewarded.
pub const HEIGHT_M: f64 = 0.26;

/// What a step is worth. The sum is the reward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terms {
    /// Follows the commanded speed.
    pub speed: f64,
    /// Follows the commanded turn rate.
    pub turn: f64,
    /// Stands upright.
    pub upright: f64,
    /// Has its height.
    pub height: f64,
    /// Does not shake.
    pub shaking: f64,
    /// Saves torque.
    pub torque: f64,
    /// Has not fallen.
    pub alive: f64,
}

/// Worth of a fall.
const FALL: f64 = -10.0;

impl Terms {
    /// The terms of a step, with the commanded speed in m/s and turn rate in rad/s, and the actions of this step and of the
    /// one before.
    pub fn new(truth: &Truth, command: [f64; 2], actions: &[f32], before: &[f32]) -> Self {
        let [speed_mps, turn_rps] = command;
        let error_mps = truth.forward_mps - speed_mps;
        let [roll, pitch] = truth.roll_pitch_rad;
        let [left_nm, right_nm] = truth.wheel_nm;
        let pairs = actions.iter().zip(before);
        let changes: f64 = pairs.map(|(now, then)| f64::from(now - then).powi(2)).sum();
        Self {
            speed: 2.0 * (-error_mps * error_mps / 0.06).exp() - 0.3 * error_mps.abs(),
            turn: 0.75 * (-(truth.yaw_rps - turn_rps).powi(2) / 0.5).exp(),
            upright: -2.0 * roll * roll - 0.5 * pitch * pitch,
            height: -10.0 * (truth.height_m - HEIGHT_M).powi(2),
            shaking: -0.02 * changes,
            torque: -0.01 * (left_nm * left_nm + right_nm * right_nm),
            alive: 0.5,
        }
    }

    /// The reward of a step that ends with a fall, or without.
    pub fn sum(&self, fallen: bool) -> f64 {
        let kept = self.speed + self.turn + self.alive;
        let paid = self.upright + self.height + self.shaking + self.torque;
        kept + paid + if fallen { FALL } else { 0.0 }
    }
}
