//! Masses seen from the hips and from the axles.

use crate::Robot;

/// The robot's mass, split into what the legs carry and what moves with the axles.
///
/// A shank's mass is shared between its ends so that its centre stays where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassSplit {
    /// Mass in kg of body, thighs and the upper part of the shanks.
    pub carried_kg: f64,
    /// Mass in kg of one wheel, its motor and the lower part of its two shanks.
    pub axle_kg: f64,
    /// Height in m of the centre of the carried mass above the hip centre, with the thighs level.
    pub carried_up_m: f64,
    /// Moment of inertia in kg·m² of the carried mass about the forward axis through its centre.
    pub roll_kgm2: f64,
    /// The same about the axis to the left.
    pub pitch_kgm2: f64,
}

impl Robot {
    /// Returns the split.
    pub fn split_mass(&self) -> MassSplit {
        let (body, legs, wheels) = (&self.body, &self.legs, &self.wheels);
        let lower_share = legs.shank.com_m / legs.shank.length_m;
        let lower_kg = legs.shank.mass_kg * lower_share;
        // Four thighs and the upper part of four shanks, in the legs' planes and, with the thighs level, at hip height.
        let links_kg = 4.0 * (legs.thigh.mass_kg + legs.shank.mass_kg - lower_kg);
        let carried_kg = body.mass_kg + links_kg;
        let carried_up_m = body.mass_kg * body.com_m[2] / carried_kg;
        let body_up_m = body.com_m[2] - carried_up_m;
        let thigh_ahead_m = legs.hip_gap_m / 2.0 + legs.thigh.com_m;
        MassSplit {
            carried_kg,
            axle_kg: wheels.mass_kg + wheels.motor_mass_kg + 2.0 * lower_kg,
            carried_up_m,
            roll_kgm2: body.inertia_kgm2[0]
                + body.mass_kg * body_up_m.powi(2)
                + links_kg * (legs.plane_y_m.powi(2) + carried_up_m.powi(2)),
            pitch_kgm2: body.inertia_kgm2[1]
                + body.mass_kg * body_up_m.powi(2)
                + links_kg * (thigh_ahead_m.powi(2) + carried_up_m.powi(2)),
        }
    }
}
