//! The five-bar closed at a place of the axle.

use crate::{Carrier, Legs, five_bar::FiveBar};

/// Angles of one leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stance {
    front: Bend,
    rear: Bend,
}

/// Angles in rad of a thigh, and of the shank below it relative to it, about −y. A knee is at 0 where the shank continues
/// the thigh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    pub(crate) hip_rad: f64,
    pub(crate) knee_rad: f64,
}

impl Stance {
    /// The leg with its axle `length_m` straight below the hip centre, its knees outward. Angles are not numbers where the
    /// links do not reach.
    pub(crate) fn of_length(legs: &Legs, length_m: f64) -> Self {
        let leg = FiveBar::new(legs);
        let nowhere = [f64::NAN; 2];
        let hips_rad = leg.hips_rad(length_m, 0.0).unwrap_or(nowhere);
        let knees_rad = leg.knees_rad(hips_rad).unwrap_or(nowhere);
        let [front, rear] = [0, 1].map(|end| Bend {
            hip_rad: hips_rad[end],
            knee_rad: knees_rad[end],
        });
        Self { front, rear }
    }

    /// Of one of the two sides.
    pub(crate) fn bend(&self, end: Carrier) -> Bend {
        match end {
            Carrier::Front => self.front,
            Carrier::Rear => self.rear,
        }
    }
}
