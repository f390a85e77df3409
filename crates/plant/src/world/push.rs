//! A push against the free robot.

use crate::time::{MS, Ps, to_seconds};

/// A push that begins now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Impulse in N·s: along the robot's heading, to its left, up. The heading is that of the moment at which it begins.
    pub impulse_ns: [f64; 3],
    /// Where it meets the body, in body axes, m. Unset, at the body's centre of mass.
    pub at_m: Option<[f64; 3]>,
    /// How long it lasts.
    pub lasts: Ps,
}

impl Push {
    /// A push in one instant (10 ms) at the body's centre of mass.
    pub fn instant(impulse_ns: [f64; 3]) -> Self {
        Self {
            impulse_ns,
            at_m: None,
            lasts: 10 * MS,
        }
    }

    /// Force in world axes while it lasts, for a robot that heads there.
    pub(super) fn force_n(&self, yaw_rad: f64) -> [f64; 3] {
        let (sin, cos) = yaw_rad.sin_cos();
        let [ahead, left, up] = self.impulse_ns.map(|ns| ns / to_seconds(self.lasts.max(1)));
        [cos * ahead - sin * left, sin * ahead + cos * left, up]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_follows_the_heading_and_makes_up_the_impulse() {
        let push = Push::instant([1.0, 0.5, 0.2]);
        let force_n = push.force_n(std::f64::consts::FRAC_PI_2);
        for (force_n, wanted) in force_n.iter().zip([-50.0, 100.0, 20.0]) {
            assert!((force_n - wanted).abs() < 1e-9, "{force_n} {wanted}");
        }
    }
}
