//! The faults that tip or strike the free robot.

use super::Stance;
use crate::{free::Push, physics::STANDARD_GRAVITY_MPS2};

/// Above the hip centre, m.
const ABOVE_M: [f64; 3] = [0.0, 0.0, 0.12];
/// A hand that pushes with the robot's weight until nothing could hold it.
const HAND_S: f64 = 0.3;
/// A blow that gives the whole robot this speed.
const BLOW_MPS: f64 = 4.0;
const BLOW_S: f64 = 5e-3;

/// A force forward that begins with a fault. Nobody puts the robot upright when the fault ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shove {
    mass_kg: f64,
    stance: Stance,
    force_n: f64,
    left_s: f64,
}

impl Shove {
    pub(super) fn new(mass_kg: f64) -> Self {
        Self {
            mass_kg,
            stance: Stance::Upright,
            force_n: 0.0,
            left_s: 0.0,
        }
    }

    /// The force during the next step, for a robot that heads there.
    pub(super) fn step(&mut self, stance: Stance, yaw_rad: f64, dt_s: f64) -> Option<Push> {
        if stance != self.stance {
            self.stance = stance;
            (self.force_n, self.left_s) = match stance {
                Stance::Upright => (0.0, 0.0),
                Stance::Fallen => (self.mass_kg * STANDARD_GRAVITY_MPS2, HAND_S),
                Stance::Struck => (self.mass_kg * BLOW_MPS / BLOW_S, BLOW_S),
            };
        }
        if self.left_s <= 0.0 {
            return None;
        }
        self.left_s -= dt_s;
        let (sin, cos) = yaw_rad.sin_cos();
        Some(Push {
            force_n: [self.force_n * cos, self.force_n * sin, 0.0],
            at_m: ABOVE_M,
        })
    }
}
