//! Which wheel to believe, and how long to do without any.

use super::{
    slip::Grip,
    wheel_speed::{self, ForwardSpeeds},
    zero_velocity::WheelEvidence,
};

/// How long the accelerometer carries on alone: with the horizon 1° off the velocity is 0.34 m/s off by then.
const MAX_COAST_S: f32 = 2.0;
/// Wheels that rolled for so long without a break are proven.
const PROOF_S: f32 = 1.0;
/// A rim slower than this stands.
const STANDING_MPS: f32 = 0.02;

/// What the wheels say, as how much faster they run than the robot, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Word {
    /// At least one wheel rolls, and has for long enough to show what the accelerometer's offset is.
    Proven(f32),
    /// At least one wheel rolls, for now.
    Believed(f32),
    /// All that are heard slip, so they do not hold sideways either; the accelerometer carries on.
    Sliding,
    /// None is heard; the accelerometer carries on.
    Unheard,
    /// At least one wheel rolls again, or they slipped for so long that the accelerometer is no better: from here on the
    /// robot rolls straight on at this speed.
    Anew(f32),
    /// None is heard, and the accelerometer no longer counts either.
    None,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct WheelTrust {
    grip: [Grip; 2],
    /// Since a wheel was last believed.
    coasting_s: f32,
    /// Since then without a break.
    rolling_s: f32,
}

impl WheelTrust {
    /// Has never heard a wheel.
    pub const fn new() -> Self {
        Self {
            grip: [Grip::Rolling; 2],
            coasting_s: MAX_COAST_S,
            rolling_s: 0.0,
        }
    }

    /// Too long without wheels for the accelerometer to count.
    pub fn is_lost(&self) -> bool {
        self.coasting_s >= MAX_COAST_S
    }

    /// `surplus`: wheel speeds less the robot's.
    pub fn step(&mut self, surplus: ForwardSpeeds, dt_s: f32) -> Word {
        let mut rolling = surplus;
        for (grip, surplus) in self.grip.iter_mut().zip(&mut rolling) {
            *grip = surplus.map_or(Grip::Rolling, |mps| grip.step(mps, dt_s));
            if !grip.rolls() {
                *surplus = None;
            }
        }
        if self.is_lost() {
            return self.start_over(surplus);
        }
        if let Some(surplus_mps) = wheel_speed::mean(rolling) {
            return self.roll(surplus_mps, dt_s);
        }
        self.rolling_s = 0.0;
        self.coasting_s += dt_s;
        if surplus == [None; 2] {
            Word::Unheard
        } else {
            Word::Sliding
        }
    }

    fn roll(&mut self, surplus_mps: f32, dt_s: f32) -> Word {
        if self.coasting_s > 0.0 {
            self.coasting_s = 0.0;
            return Word::Anew(surplus_mps);
        }
        if self.rolling_s < PROOF_S {
            self.rolling_s += dt_s;
            return Word::Believed(surplus_mps);
        }
        Word::Proven(surplus_mps)
    }

    fn start_over(&mut self, surplus: ForwardSpeeds) -> Word {
        let Some(surplus_mps) = wheel_speed::mean(surplus) else {
            return Word::None;
        };
        self.grip = [Grip::Rolling; 2];
        self.coasting_s = 0.0;
        self.rolling_s = 0.0;
        Word::Anew(surplus_mps)
    }

    /// The robot stands still: wheels that stand say so rightly.
    pub fn confirm(&mut self, wheels: WheelEvidence) {
        if wheels == WheelEvidence::Standing {
            self.coasting_s = 0.0;
            self.rolling_s = PROOF_S;
        }
    }

    /// What the wheels say about standing still.
    pub fn evidence(&self, speeds: ForwardSpeeds) -> WheelEvidence {
        if speeds == [None; 2] {
            return WheelEvidence::Silent;
        }
        let stands = |(speed, grip): (Option<f32>, Grip)| {
            speed.is_none_or(|mps| grip.rolls() && mps.abs() <= STANDING_MPS)
        };
        if speeds.into_iter().zip(self.grip).all(stands) {
            WheelEvidence::Standing
        } else {
            WheelEvidence::Turning
        }
    }
}
