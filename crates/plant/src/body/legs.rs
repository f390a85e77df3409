//! Four leg links that hang from the hips, each an independent pendulum.
//!
//! The linkage that couples the two joints of a leg, and the body's weight on it, are not modelled.

use super::shaft::turn_shaft;
use crate::{joints::JOINTS, m3508::Friction};

/// Inertia of a link about its hip, with the reflected rotor. An assumption.
const INERTIA_KGM2: f64 = 0.02;
/// Gravity torque of a link that is held level. An assumption.
const GRAVITY_NM: f64 = 1.0;

/// Angle of each joint from hanging down, and its speed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Legs {
    pub(crate) pos_rad: [f64; JOINTS],
    pub(crate) vel_rps: [f64; JOINTS],
}

impl Legs {
    pub(crate) fn step(&mut self, joint: usize, torque_nm: f64, friction_nm: f64, dt_s: f64) {
        let friction = Friction {
            dry_nm: friction_nm,
            viscous_nm_per_rps: 0.0,
        };
        let driving_nm = torque_nm - GRAVITY_NM * self.pos_rad[joint].sin();
        let vel_rps = &mut self.vel_rps[joint];
        *vel_rps = turn_shaft(*vel_rps, driving_nm, friction, INERTIA_KGM2, dt_s);
        self.pos_rad[joint] += *vel_rps * dt_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 250e-6;

    #[test]
    fn a_link_falls_as_a_pendulum_does() {
        let mut legs = Legs {
            pos_rad: [0.1, 0.0, 0.0, 0.0],
            ..Legs::default()
        };
        // ω² = 1 N·m / 0.02 kg·m², so a quarter period of small swings is π/2 / 7.07 = 0.222 s.
        let mut steps = 0;
        while legs.pos_rad[0] > 0.0 {
            legs.step(0, 0.0, 0.0, DT_S);
            steps += 1;
        }
        let seconds = f64::from(steps) * DT_S;
        assert!((seconds - 0.222).abs() < 0.002, "{seconds}");
        assert!((legs.vel_rps[0] + 0.707).abs() < 0.005, "{legs:?}");
    }

    #[test]
    fn friction_holds_a_link_that_weighs_less() {
        // sin 0.14 rad = 0.1395 N·m against 0.15.
        let mut legs = Legs {
            pos_rad: [0.14; JOINTS],
            ..Legs::default()
        };
        for _ in 0..4_000 {
            legs.step(2, 0.0, 0.15, DT_S);
        }
        assert_eq!((legs.pos_rad[2], legs.vel_rps[2]), (0.14, 0.0));
    }
}
