//! How body and legs of a robot that has been pushed help its wheels, which must get ahead of it before it can brake.
//!
//! A body that pitches towards where it falls pushes the legs the other way, under it, and turns back while the robot brakes.
//! Then the hips go down: legs reach further to the front.

use super::ramp::Ramp;
use crate::math::scalar;

/// Hips that are too fast by this, in m/s, and by so much more need all the help.
const SLOW_MPS: f32 = 0.3;
const SPAN_MPS: f32 = 0.4;
/// Time in s over which the present rate of lean counts.
const AHEAD_S: f32 = 0.05;
/// Pitch in rad for a lean of 1 rad towards where the robot falls, while it leans back to brake, and in a planned stop. All constants
/// of this file were found together, by a search over simulated robots.
const CATCH_PITCH: f32 = 1.06;
const BRAKE_PITCH: f32 = 0.145;
const STOP_PITCH: f32 = 0.12;
/// Largest pitch in rad, and the rate in 1/s with which it is reached. From 0.7 rad of tilt on safety takes the robot for fallen
/// (`safety.max-balance-tilt-rad`).
const MOST_PITCH_RAD: f32 = 0.5;
const PITCH_PER_S: f32 = 7.5;
/// How much lower the hips are in m for a lean of 1 rad of a robot that brakes, and in a planned stop.
const BRAKE_DIP_M: f32 = 0.137;
const STOP_DIP_M: f32 = 0.088;
/// Natural frequency in rad/s, well damped, with which the hips get there.
const DIP_RPS: f32 = 7.8;
/// Less than this in rad and m is nothing.
const LEAST: f32 = 1e-3;

/// How a robot moves that has been pushed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fall {
    /// It was not pushed, or the push is over.
    Over,
    /// It stops as planned, with this lean in rad.
    Stops { lean_rad: f32 },
    /// Its hips are too fast by `fast_mps` in m/s and it leans by so much, in rad and rad/s.
    Falls {
        fast_mps: f32,
        lean_rad: f32,
        lean_rps: f32,
    },
}

/// The help of body and legs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Catch {
    /// Pitch of the body in rad.
    pub pitch: Ramp,
    /// By how much the hips are higher than the pilot wishes, in m.
    pub height: Ramp,
    /// Body and legs help, or come back from it.
    pub helps: bool,
}

impl Catch {
    /// Moves on by `dt_s`.
    pub fn step(&mut self, fall: Fall, dt_s: f32) {
        let (pitch_rad, height_m) = fall.help();
        let pitch_rad = scalar::clamp(pitch_rad, -MOST_PITCH_RAD, MOST_PITCH_RAD);
        self.pitch.rate = (pitch_rad - self.pitch.value) * PITCH_PER_S;
        self.pitch.value += self.pitch.rate * dt_s;
        let off_m = height_m - self.height.value;
        self.height.rate += DIP_RPS * (DIP_RPS * off_m - 2.0 * self.height.rate) * dt_s;
        self.height.value += self.height.rate * dt_s;
        let rests = self.pitch.value.abs() < LEAST && self.height.value.abs() < LEAST;
        self.helps = fall != Fall::Over || !rests;
        if !self.helps {
            *self = Self::default();
        }
    }
}

impl Fall {
    /// The pitch in rad and the height in m that help.
    fn help(self) -> (f32, f32) {
        match self {
            Self::Over => (0.0, 0.0),
            Self::Stops { lean_rad } => (STOP_PITCH * lean_rad, -STOP_DIP_M * lean_rad.abs()),
            Self::Falls {
                fast_mps,
                lean_rad,
                lean_rps,
            } => {
                let part = scalar::clamp((fast_mps.abs() - SLOW_MPS) / SPAN_MPS, 0.0, 1.0);
                let soon_rad = part * (lean_rad + AHEAD_S * lean_rps);
                if soon_rad * fast_mps > 0.0 {
                    (CATCH_PITCH * soon_rad, 0.0)
                } else {
                    (BRAKE_PITCH * soon_rad, -BRAKE_DIP_M * soon_rad.abs())
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
