//! Does the robot stand still?

use crate::math::{Vector3, scalar, vector};

/// Quiet for this long while the wheels stand …
const STANDING_S: f32 = 0.3;
/// … or, while no wheel is heard, for so long that the speed has faded already.
const UNHEARD_S: f32 = 4.0;
/// Quiet: turns slower than this (5.7 °/s), so that an offset of the gyro that is not known yet does not matter, …
const MAX_RATE_RPS: f32 = 0.1;
/// … feels the same force within this as in the last moments …
const MAX_CHANGE_MPS2: f32 = 0.3;
const SMOOTHING_S: f32 = 0.2;
/// … and none beyond gravity but what offset and tilt may explain. A robot that slides on locked wheels feels more.
const MAX_FREE_MPS2: f32 = 1.0;

/// What the wheels say about standing still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WheelEvidence {
    /// All that are heard stand, and none slips.
    Standing,
    /// At least one rolls.
    Turning,
    /// All that turn slip.
    Spinning,
    Silent,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct ZeroVelocity {
    /// None before the first sample.
    smooth_mps2: Option<Vector3>,
    quiet: bool,
    quiet_s: f32,
}

impl ZeroVelocity {
    pub const fn new() -> Self {
        Self {
            smooth_mps2: None,
            quiet: false,
            quiet_s: 0.0,
        }
    }

    /// The last sample was.
    pub const fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// `accel_mps2`: specific force in body axes and what is left of it without gravity and offset. `stood`: nothing but
    /// the wheels speaks against the robot's still standing. True while the robot stands still.
    pub fn feed(
        &mut self,
        accel_mps2: (Vector3, Vector3),
        rate_rps: Vector3,
        wheels: WheelEvidence,
        stood: bool,
        dt_s: f32,
    ) -> bool {
        self.quiet = self.judge(accel_mps2, rate_rps, dt_s);
        let needed_s = match wheels {
            WheelEvidence::Standing => STANDING_S,
            WheelEvidence::Silent => UNHEARD_S,
            WheelEvidence::Spinning => return stood && self.quiet,
            WheelEvidence::Turning => {
                self.quiet_s = 0.0;
                return false;
            }
        };
        self.quiet_s = if self.quiet { self.quiet_s + dt_s } else { 0.0 };
        self.quiet_s >= needed_s
    }

    fn judge(
        &mut self,
        (felt_mps2, free_mps2): (Vector3, Vector3),
        rate_rps: Vector3,
        dt_s: f32,
    ) -> bool {
        let smooth_mps2 = self.smooth_mps2.unwrap_or(felt_mps2);
        let change = vector::sub(felt_mps2, smooth_mps2);
        let share = scalar::min(dt_s / SMOOTHING_S, 1.0);
        self.smooth_mps2 = Some(vector::add(smooth_mps2, vector::scale(change, share)));
        is_shorter(rate_rps, MAX_RATE_RPS)
            && is_shorter(change, MAX_CHANGE_MPS2)
            && is_shorter(free_mps2, MAX_FREE_MPS2)
    }
}

fn is_shorter(v: Vector3, limit: f32) -> bool {
    vector::dot(v, v) < limit * limit
}
