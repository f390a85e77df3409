//! How far a leg reaches to the side that the ranges of its hips allow.

use crate::{Robot, figures, five_bar::FiveBar};

/// Angles in rad between which the reach is taken as a line. Where no leg fits at the far one, the last angle at which one does
/// takes its place, and the near one moves in as much.
const ANGLES_RAD: [f64; 2] = [0.3, 0.8];
const STEPS: u32 = 400;

/// Longest leg: `down_m` less `less_m_per_rad` for each radian from straight down.
///
/// A leg that swings turns one hip towards its stop, the more the longer it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Length in m straight down, of the line; the leg itself may be shorter.
    pub down_m: f64,
    /// How much less by angle, in m/rad.
    pub less_m_per_rad: f64,
}

impl Robot {
    /// Returns the reach.
    pub fn reach(&self) -> Reach {
        let [near_rad, far_rad] = self.angles_rad();
        let [near_m, far_m] = [near_rad, far_rad]
            .map(|angle_rad| self.longest_m(angle_rad).unwrap_or(self.legs.min_m));
        let less_m_per_rad = ((near_m - far_m) / (far_rad - near_rad)).max(0.0);
        Reach {
            down_m: near_m + less_m_per_rad * near_rad,
            less_m_per_rad,
        }
    }

    fn angles_rad(&self) -> [f64; 2] {
        let [near_rad, far_rad] = ANGLES_RAD;
        (1..=STEPS)
            .rev()
            .map(|step| f64::from(step) / f64::from(STEPS))
            .find(|share| self.longest_m(share * far_rad).is_some())
            .map_or(ANGLES_RAD, |share| [share * near_rad, share * far_rad])
    }

    /// Longest usable leg at this angle to either side, if one fits.
    fn longest_m(&self, angle_rad: f64) -> Option<f64> {
        let leg = FiveBar::new(&self.legs);
        let fits = |length_m: f64, angle_rad: f64| {
            let hips_rad = leg.hips_rad(length_m, angle_rad);
            hips_rad.is_some_and(|hips_rad| figures::in_range(self, hips_rad))
        };
        let (min_m, max_m) = (self.legs.min_m, self.legs.max_m);
        let step_m = (max_m - min_m) / f64::from(STEPS);
        (0..=STEPS)
            .map(|step| max_m - step_m * f64::from(step))
            .find(|length_m| fits(*length_m, angle_rad) && fits(*length_m, -angle_rad))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn robot(name: &str) -> Robot {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
        Robot::read(&folder.join(name)).expect("a robot of this repository")
    }

    #[test]
    fn the_line_is_within_millimetres_of_the_hips_stops() {
        for name in ["fivebar.toml", "fivebar-rs00.toml"] {
            let robot = robot(name);
            let reach = robot.reach();
            for angle_rad in [0.4, 0.5, 0.6, 0.7] {
                let line_m = reach.down_m - reach.less_m_per_rad * angle_rad;
                let longest_m = robot.longest_m(angle_rad).expect("a leg fits");
                assert!(
                    (line_m - longest_m).abs() < 0.005,
                    "{name}, {angle_rad}: {line_m} {longest_m}"
                );
            }
        }
    }

    /// By the cosine law: rear hip at its stop of 1.35 rad.
    #[test]
    fn the_longest_leg_is_that_of_a_hand_calculation() {
        let longest_m = robot("fivebar.toml").longest_m(0.55).expect("a leg fits");
        assert!((longest_m - 0.24).abs() < 0.003);
    }
}
