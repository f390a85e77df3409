//! The five-bar closed at a place of the axle.

use crate::{Carrier, Legs};

/// Angles of one leg in rad.
///
/// Each is that of a link, or of a shank relative to its thigh, about −y. A knee is at 0 where the shank continues the
/// thigh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stance {
    /// Of the front hip and knee.
    pub(crate) front: Bend,
    /// Of the rear hip and knee.
    pub(crate) rear: Bend,
}

/// Angles of a thigh and the shank below it in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    pub(crate) hip_rad: f64,
    pub(crate) knee_rad: f64,
}

impl Stance {
    /// The leg with its axle `length_m` straight below the hip centre, its knees outward.
    pub(crate) fn of_length(legs: &Legs, length_m: f64) -> Self {
        let [l1, l2] = [legs.thigh.length_m, legs.shank.length_m];
        // From the front hip.
        let [x, z] = [-legs.hip_gap_m / 2.0, -length_m];
        let to_axle = x.hypot(z);
        let at_hip = ((l1 * l1 + to_axle * to_axle - l2 * l2) / (2.0 * l1 * to_axle)).acos();
        let at_knee = ((l1 * l1 + l2 * l2 - to_axle * to_axle) / (2.0 * l1 * l2)).acos();
        let front = Bend {
            hip_rad: z.atan2(x) + at_hip,
            knee_rad: at_knee - std::f64::consts::PI,
        };
        let rear = Bend {
            hip_rad: -front.hip_rad,
            knee_rad: -front.knee_rad,
        };
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
