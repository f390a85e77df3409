//! What it takes to stand still, learned while balancing: errors of the centre of mass, slopes, an oblique board.

use super::{gains::INPUTS, support::GRAVITY_MPS2};
use crate::math::scalar;

/// Time constants in s of observing the lean, of following it, and of learning the torques.
const LEAN_TIME_S: f32 = 0.3;
const FOLLOW_TIME_S: f32 = 0.1;
const TORQUE_TIME_S: f32 = 0.6;
/// A robot that rolls as fast as this, in m/s, is not held by friction.
const ROLLING_MPS: f32 = 0.03;
/// A torque in N·m that friction may hold. To learn it too would make the robot creep to and fro.
const STICTION_NM: f32 = 0.18;
/// Limits of what is learned.
const MAX_OFFSET_M: f32 = 0.07;
const MAX_WHEEL_NM: f32 = 2.0;
const MAX_LEG_NM: f32 = 4.0;

/// The lean and the torques at which the robot stands still.
///
/// The lean is observed: it is what the motion does not explain. Each torque follows what the state feedback holds on
/// average, so that no error is left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trim {
    /// Lean of both legs times their length, in m: how far the hips are ahead of the axles.
    pub offset_m: f32,
    /// Torque of each wheel in N·m.
    pub wheel_nm: f32,
    /// Torque of the body on each leg in N·m.
    pub leg_nm: f32,
    /// Lean, its rate and the speed behind low-pass filters. Differences from them are accelerations behind the same
    /// filter.
    filtered: Motion,
}

/// Motion of the legs and axles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Mean lean of the legs in rad.
    pub lean_rad: f32,
    /// Its rate in rad/s.
    pub lean_rps: f32,
    /// Speed of the axles in m/s.
    pub speed_mps: f32,
}

impl Trim {
    /// Begins at this motion.
    pub fn new(motion: Motion) -> Self {
        Self {
            filtered: motion,
            ..Self::default()
        }
    }

    /// Forgets how the robot moved, for instance in the air.
    pub fn restart(&mut self, motion: Motion) {
        self.filtered = motion;
    }

    /// The lean in rad at which the robot would stand still, from the last tenths of a second. An acceleration of the
    /// axles takes `lean_per_mps2`.
    pub fn observe(
        &mut self,
        motion: &Motion,
        lean_per_mps2: f32,
        length_m: f32,
        dt_s: f32,
    ) -> f32 {
        let filtered = &mut self.filtered;
        let accel_mps2 = (motion.speed_mps - filtered.speed_mps) / LEAN_TIME_S;
        let accel_rpss = (motion.lean_rps - filtered.lean_rps) / LEAN_TIME_S;
        let lean_rps = (motion.lean_rad - filtered.lean_rad) / LEAN_TIME_S;
        filtered.speed_mps += accel_mps2 * dt_s;
        filtered.lean_rps += accel_rpss * dt_s;
        filtered.lean_rad += lean_rps * dt_s;
        filtered.lean_rad - lean_per_mps2 * accel_mps2 - length_m / GRAVITY_MPS2 * accel_rpss
    }

    /// Takes the observed lean, and learns from the torques of the state feedback beyond the present trim.
    pub fn learn(&mut self, offset_m: f32, beyond_nm: [f32; INPUTS], dt_s: f32) {
        let share = dt_s / TORQUE_TIME_S;
        let [left_wheel, right_wheel, left_leg, right_leg] = beyond_nm;
        let learned = |trim_nm: f32, left_nm: f32, right_nm: f32, limit_nm: f32| {
            let beyond_nm = 0.5 * (left_nm + right_nm);
            let within_nm = scalar::clamp(beyond_nm, -STICTION_NM, STICTION_NM);
            let wanted_nm = trim_nm + (beyond_nm - within_nm) * share;
            scalar::clamp(wanted_nm, -limit_nm, limit_nm)
        };
        let wanted_m = scalar::clamp(offset_m, -MAX_OFFSET_M, MAX_OFFSET_M);
        // Friction holds a robot that does not roll, whatever its lean.
        let rolls = scalar::min(self.filtered.speed_mps.abs() / ROLLING_MPS, 1.0);
        self.offset_m += (wanted_m - self.offset_m) * (rolls * dt_s / FOLLOW_TIME_S);
        self.wheel_nm = learned(self.wheel_nm, left_wheel, right_wheel, MAX_WHEEL_NM);
        self.leg_nm = learned(self.leg_nm, left_leg, right_leg, MAX_LEG_NM);
    }
}
