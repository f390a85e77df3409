//! Slip detection for one wheel.
//!
//! A wheel slips if its speed differs too much from the filter's. The filter follows the wheels with a time constant T of
//! 1/3.9 s. A wheel that lastingly accelerates by a m/s² more than the accelerometer shows is therefore a·T ahead of the
//! filter. A limit on the speed is therefore also one on the acceleration, limit / T = 1.2 m/s², and needs no derivative.

/// Speed error beyond which a wheel slips.
const SLIP_MPS: f32 = 0.3;
/// Speed error within which a slipping wheel may roll again.
const ROLL_MPS: f32 = 0.05;
/// Growth of that tolerance while the wheel slips, because the inertial speed drifts: a tilt error of 0.3°.
const DRIFT_MPS2: f32 = 0.05;
/// Time within the tolerance after which it rolls.
const AGREE_S: f32 = 0.1;

/// Whether a wheel rolls or slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SlipState {
    Rolling,
    Slipping {
        /// Time since it began to slip.
        since_s: f32,
        /// Time within the tolerance for rolling.
        agreed_s: f32,
    },
}

impl SlipState {
    /// `slip_mps` is the wheel's speed less the robot's.
    pub fn step(self, slip_mps: f32, dt_s: f32) -> Self {
        let error_mps = slip_mps.abs();
        match self {
            Self::Rolling if error_mps > SLIP_MPS => Self::SLIPPING,
            Self::Rolling => Self::Rolling,
            Self::Slipping { since_s, agreed_s } => {
                let drift_mps = DRIFT_MPS2 * since_s;
                let close = error_mps <= ROLL_MPS + drift_mps && error_mps < SLIP_MPS;
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

    /// The state of a wheel that has just begun to slip.
    pub const SLIPPING: Self = Self::Slipping {
        since_s: 0.0,
        agreed_s: 0.0,
    };

    /// Like [`Self::step`], but for a robot at a standstill, whose speed does not drift.
    pub fn step_at_standstill(self, speed_mps: f32, dt_s: f32) -> Self {
        match self.step(speed_mps, dt_s) {
            Self::Slipping { agreed_s, .. } => Self::Slipping {
                since_s: 0.0,
                agreed_s,
            },
            Self::Rolling => Self::Rolling,
        }
    }

    pub fn is_rolling(self) -> bool {
        self == Self::Rolling
    }
}
