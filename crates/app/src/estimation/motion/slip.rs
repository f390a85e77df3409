//! Does one wheel roll, or does it spin or slide?
//!
//! The filter forgets what the wheels said with a time constant T (1/3.9 s), so a wheel that gains on the accelerometer
//! by a m/s² for good is a·T ahead of it: comparing speeds against a limit compares accelerations against limit / T,
//! 1.2 m/s², without taking the derivative of a speed.

/// A wheel further than this from the speed known otherwise slips.
const SLIP_MPS: f32 = 0.3;
/// It rolls again once it has stayed this close …
const ROLL_MPS: f32 = 0.05;
/// … or closer than the speed known otherwise may have drifted off meanwhile: a quarter of a degree of the horizon …
const DRIFT_MPS2: f32 = 0.05;
/// … for this long.
const AGREE_S: f32 = 0.1;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grip {
    Rolling,
    Slipping {
        /// Since it began to slip.
        since_s: f32,
        /// Since it came close.
        agreed_s: f32,
    },
}

impl Grip {
    /// `surplus_mps`: how much faster than the robot the wheel runs.
    pub fn step(self, surplus_mps: f32, dt_s: f32) -> Self {
        let off_mps = surplus_mps.abs();
        match self {
            Self::Rolling if off_mps > SLIP_MPS => Self::SLIPPING,
            Self::Rolling => Self::Rolling,
            Self::Slipping { since_s, agreed_s } => {
                let drift_mps = DRIFT_MPS2 * since_s;
                let close = off_mps <= ROLL_MPS + drift_mps && off_mps < SLIP_MPS;
                let agreed_s = if close { agreed_s + dt_s } else { 0.0 };
                if agreed_s >= AGREE_S {
                    return Self::Rolling;
                }
                Self::Slipping {
                    since_s: since_s + dt_s,
                    agreed_s,
                }
            }
        }
    }

    pub const SLIPPING: Self = Self::Slipping {
        since_s: 0.0,
        agreed_s: 0.0,
    };

    /// As `step`, where what is known otherwise does not drift.
    pub fn step_beside_rest(self, speed_mps: f32, dt_s: f32) -> Self {
        match self.step(speed_mps, dt_s) {
            Self::Slipping { agreed_s, .. } => Self::Slipping {
                since_s: 0.0,
                agreed_s,
            },
            Self::Rolling => Self::Rolling,
        }
    }

    pub fn rolls(self) -> bool {
        self == Self::Rolling
    }
}
