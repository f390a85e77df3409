//! Wheels that slip, seen by the difference of their speed and the estimate's.

use super::measured::Measured;
use crate::{domain::WheelOdomConfig, math::scalar};

/// Largest difference in m/s between the wheels and the estimate with which the wheels tell the robot's speed. In motion the estimate
/// follows them late.
const ROLLING_MPS: f32 = 0.32;
/// Two loaded wheels roll if the ground holds each of them back by less than this torque in N·m, over this time in s: even little
/// friction brakes a slip by more. An estimate that still tells another speed has drifted, and that is learned with this time
/// constant in s.
const ROLLING_NM: f32 = 0.25;
const WATCHED_S: f32 = 0.1;
const DRIFT_TIME_S: f32 = 0.05;
/// A wheel that slips by more, in m/s, and for so long, in s, slips.
const SLIPPING_MPS: f32 = 0.3;
const SLIPPING_S: f32 = 0.02;
/// Time constant in s with which a slip is forgotten.
const LATELY_S: f32 = 2.0;
/// The torque that makes a wheel slip is reduced from the first of these, in m/s, and zero at the second one.
const REDUCED_MPS: f32 = 0.6;
const NONE_MPS: f32 = 1.3;

/// Slip of both wheels, left and right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slip {
    /// Speed of each tyre over the ground in m/s, forward positive where the wheel turns too fast.
    mps: [f32; 2],
    /// Time in s for which a wheel has slipped.
    lasts_s: f32,
    watch: Watch,
    /// At the end of the last watch the wheels rolled.
    rolls: bool,
    /// Speed in m/s by which the estimate is behind wheels that roll.
    drift_mps: f32,
    /// Largest slip of late in m/s.
    pub lately_mps: f32,
}

/// What wheels do that the estimate contradicts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Watch {
    lasts_s: f32,
    /// What each wheel has got, in N·m·s.
    impulse_nms: f32,
    /// Speed of the axles in m/s at the beginning, by the wheels.
    begun_mps: f32,
}

impl Slip {
    /// Speed of the axles in m/s: that by the wheels, within some distance of the estimate's, which knows of slip.
    pub fn rolling_mps(&self, measured: &Measured) -> f32 {
        let ground_mps = measured.ground_mps + self.drift_mps;
        ground_mps + scalar::clamp(measured.speed_mps - ground_mps, -ROLLING_MPS, ROLLING_MPS)
    }

    /// Begins with an estimate that is behind wheels that roll by so much, in m/s.
    pub fn begin_behind(&mut self, mps: f32) {
        self.drift_mps = if mps.abs() < ROLLING_MPS { 0.0 } else { mps };
    }

    /// Goes on by `dt_s`. The wheels, each with its rotor as heavy to turn as `wheel_kgm2`, got `wheels_nm`, and carry a load if
    /// they are `loaded`.
    pub fn step(
        &mut self,
        odometry: &WheelOdomConfig,
        wheel_kgm2: f32,
        measured: &Measured,
        wheels_nm: [f32; 2],
        loaded: bool,
        dt_s: f32,
    ) {
        let turn_kgm = wheel_kgm2 / odometry.wheel_radius_m;
        self.learn_drift(turn_kgm, measured, wheels_nm, loaded, dt_s);
        let ground_mps = measured.ground_mps + self.drift_mps;
        let turn_mps = 0.5 * odometry.wheel_track_m * measured.tilt.yaw_rps;
        let [left_rps, right_rps] = measured.wheel_rps;
        let radius_m = odometry.wheel_radius_m;
        self.mps = [
            radius_m * left_rps - (ground_mps - turn_mps),
            radius_m * right_rps - (ground_mps + turn_mps),
        ];
        let [left_mps, right_mps] = self.mps;
        let most_mps = scalar::max(left_mps.abs(), right_mps.abs());
        let faded_mps = self.lately_mps - self.lately_mps * (dt_s / LATELY_S);
        self.lately_mps = scalar::max(faded_mps, most_mps);
        self.lasts_s = if most_mps > SLIPPING_MPS {
            self.lasts_s + dt_s
        } else {
            0.0
        };
    }

    /// `turn_kgm` is what turns each wheel by 1 m/s, in N·m·s.
    fn learn_drift(
        &mut self,
        turn_kgm: f32,
        measured: &Measured,
        wheels_nm: [f32; 2],
        loaded: bool,
        dt_s: f32,
    ) {
        let behind_mps = measured.speed_mps - measured.ground_mps;
        let agrees = behind_mps.abs() < ROLLING_MPS;
        if agrees {
            self.drift_mps = 0.0;
        }
        if agrees || !loaded {
            self.rolls = false;
            self.watch = Watch::default();
            return;
        }
        self.watch.step(measured, wheels_nm, dt_s);
        if self.watch.lasts_s > WATCHED_S {
            let held_nm = self.watch.held_nm(turn_kgm, measured);
            // Friction works against a slip. What drives a wheel the other way only makes it roll.
            self.rolls = held_nm * behind_mps < ROLLING_NM * behind_mps.abs();
            self.watch = Watch::default();
        }
        if self.rolls {
            self.drift_mps += (behind_mps - self.drift_mps) * (dt_s / DRIFT_TIME_S);
        }
    }

    /// A wheel slips.
    pub fn is_slipping(&self) -> bool {
        self.lasts_s > SLIPPING_S
    }

    /// The torques less what would only make their wheels slip faster.
    pub fn within_grip(&self, wheels_nm: [f32; 2]) -> [f32; 2] {
        let ([left_nm, right_nm], [left_mps, right_mps]) = (wheels_nm, self.mps);
        [
            within_grip(left_nm, left_mps),
            within_grip(right_nm, right_mps),
        ]
    }
}

impl Watch {
    fn step(&mut self, measured: &Measured, wheels_nm: [f32; 2], dt_s: f32) {
        if self.lasts_s == 0.0 {
            self.begun_mps = measured.speed_mps;
        }
        let [left_nm, right_nm] = wheels_nm;
        self.impulse_nms += 0.5 * (left_nm + right_nm) * dt_s;
        self.lasts_s += dt_s;
    }

    /// Torque in N·m with which the ground has held each wheel back: what it got and did not turn it.
    fn held_nm(&self, turn_kgm: f32, measured: &Measured) -> f32 {
        let turned_nms = turn_kgm * (measured.speed_mps - self.begun_mps);
        (self.impulse_nms - turned_nms) / self.lasts_s
    }
}

fn within_grip(nm: f32, slip_mps: f32) -> f32 {
    if nm * slip_mps <= 0.0 {
        return nm;
    }
    nm * scalar::clamp(
        (NONE_MPS - slip_mps.abs()) / (NONE_MPS - REDUCED_MPS),
        0.0,
        1.0,
    )
}

#[cfg(test)]
mod tests;
