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
    /// The same centre ahead of the hip centre, in m.
    pub carried_ahead_m: f64,
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
        // Four thighs and the upper part of four shanks, in the legs' planes and, with the thighs level, at hip height. As many are
        // ahead of the hip centre as behind it.
        let links_kg = 4.0 * (legs.thigh.mass_kg + legs.shank.mass_kg - lower_kg);
        let carried_kg = body.mass_kg + links_kg;
        let carried_up_m = body.mass_kg * body.com_m[2] / carried_kg;
        let carried_ahead_m = body.mass_kg * body.com_m[0] / carried_kg;
        let body_up_m = body.com_m[2] - carried_up_m;
        let body_ahead_m = body.com_m[0] - carried_ahead_m;
        let thigh_ahead_m = legs.hip_gap_m / 2.0 + legs.thigh.com_m;
        MassSplit {
            carried_kg,
            axle_kg: wheels.mass_kg + wheels.motor_mass_kg + 2.0 * lower_kg,
            carried_up_m,
            carried_ahead_m,
            roll_kgm2: body.inertia_kgm2[0]
                + body.mass_kg * body_up_m.powi(2)
                + links_kg * (legs.plane_y_m.powi(2) + carried_up_m.powi(2)),
            pitch_kgm2: body.inertia_kgm2[1]
                + body.mass_kg * (body_up_m.powi(2) + body_ahead_m.powi(2))
                + links_kg
                    * (thigh_ahead_m.powi(2) + carried_up_m.powi(2) + carried_ahead_m.powi(2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split_with_body_ahead(body_ahead_m: f64) -> MassSplit {
        let text = include_str!("../../../robots/fivebar.toml");
        let mut robot = Robot::parse(text, "fivebar.toml").expect("sound");
        robot.body.com_m[0] = body_ahead_m;
        robot.split_mass()
    }

    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }

    /// Links of 4·(0.10 + 0.12·(1 − 0.10/0.22)) = 0.66182 kg at ±0.10 m, and the body of 4.30 kg. The centre is at
    /// 4.30·0.02/4.96182 = 0.017332 m, the body's 0.002668 m above it:
    /// 0.031 + 4.30·0.002668² + 0.66182·(0.10² + 0.017332²).
    #[test]
    fn inertia_of_pitch_by_hand() {
        let split = split_with_body_ahead(0.0);
        assert_eq!(split.carried_ahead_m, 0.0);
        assert_near(split.pitch_kgm2, 0.037848);
    }

    /// Body and links are 0.03 m apart, and their reduced mass is 4.30·0.66182/4.96182 = 0.57354 kg.
    #[test]
    fn a_body_ahead_of_its_hips_has_more_inertia() {
        let split = split_with_body_ahead(0.03);
        assert_near(split.carried_ahead_m, 0.03 * 4.30 / 4.961_82);
        let level = split_with_body_ahead(0.0);
        assert_near(split.pitch_kgm2 - level.pitch_kgm2, 0.57354 * 0.0009);
        assert_eq!(split.roll_kgm2, level.roll_kgm2);
    }
}
