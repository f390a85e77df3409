//! An edge that a wheel strikes: its axle stops at once, and the body goes on.

use super::measured::Measured;

/// Time constant in s of what counts as the motion before.
const BEFORE_S: f32 = 0.012;
/// Least speed in m/s at which an edge is expected.
const LEAST_MPS: f32 = 0.3;
/// A side that has struck one leans by this rate in rad/s at least. Besides, its wheel loses this speed in m/s or, where
/// little friction brakes it, its leg gets shorter at this rate in m/s.
const LEANS_RPS: f32 = 2.0;
const LOST_MPS: f32 = 0.1;
const FOLDS_MPS: f32 = 0.4;
/// Time in s for which no other one counts, and time on the ground after a flight in which none counts: a landing looks alike.
const QUIET_S: f32 = 0.6;
const LANDED_S: f32 = 0.15;

/// The motion of one side before, to compare with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Side {
    speed_mps: f32,
    lean_rps: f32,
}

/// Watches both sides, left and right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edge {
    sides: [Side; 2],
    quiet_s: f32,
}

impl Edge {
    /// Whether a wheel of a robot that has been on the ground for `grounded_s` has just struck an edge.
    pub fn step(&mut self, measured: &Measured, radius_m: f32, grounded_s: f32, dt_s: f32) -> bool {
        let motions = measured.wheel_rps.iter().zip(measured.lean_rps);
        let mut struck = false;
        for ((side, (wheel_rps, lean_rps)), leg) in
            self.sides.iter_mut().zip(motions).zip(&measured.legs)
        {
            struck |= side.step(wheel_rps * radius_m, lean_rps, leg.length_mps, dt_s);
        }
        self.quiet_s -= dt_s;
        if !struck || self.quiet_s > 0.0 || grounded_s < LANDED_S {
            return false;
        }
        self.quiet_s = QUIET_S;
        true
    }
}

impl Side {
    fn step(&mut self, speed_mps: f32, lean_rps: f32, length_mps: f32, dt_s: f32) -> bool {
        let more_mps = speed_mps - self.speed_mps;
        let more_rps = lean_rps - self.lean_rps;
        let forward = if self.speed_mps < 0.0 { -1.0 } else { 1.0 };
        let struck = self.speed_mps.abs() > LEAST_MPS
            && (more_mps * forward < -LOST_MPS || length_mps < -FOLDS_MPS)
            && more_rps * forward > LEANS_RPS;
        self.speed_mps += more_mps * (dt_s / BEFORE_S);
        self.lean_rps += more_rps * (dt_s / BEFORE_S);
        struck
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS_M: f32 = 0.06;
    const TICK_S: f32 = 0.001;

    /// Both wheels at this speed in m/s while the right leg leans at this rate in rad/s.
    fn rolling(speed_mps: f32, lean_rps: f32) -> Measured {
        Measured {
            wheel_rps: [speed_mps / RADIUS_M; 2],
            lean_rps: [0.0, lean_rps],
            ..Measured::at_rest()
        }
    }

    /// How often an edge is struck by a robot that rolls for each of these times in s, and then for a moment moves so.
    fn strikes(rolls_s: &[f32], forward: f32, [speed_mps, lean_rps]: [f32; 2]) -> Vec<bool> {
        let mut edge = Edge::default();
        let mut step = |[speed_mps, lean_rps]: [f32; 2]| {
            let measured = rolling(forward * speed_mps, forward * lean_rps);
            edge.step(&measured, RADIUS_M, 1.0, TICK_S)
        };
        let struck = rolls_s.iter().map(|roll_s| {
            for _ in 0..(roll_s / TICK_S) as usize {
                assert!(!step([1.0, 0.0]));
            }
            step([speed_mps, lean_rps])
        });
        struck.collect()
    }

    #[test]
    fn a_wheel_that_loses_speed_while_its_leg_leans_has_struck_an_edge_once() {
        for forward in [1.0, -1.0] {
            let found = strikes(&[0.1, 0.3, 0.4], forward, [0.8, 3.0]);
            assert_eq!(found, [true, false, true]);
        }
    }

    #[test]
    fn neither_braking_nor_leaning_alone_is_an_edge() {
        for forward in [1.0, -1.0] {
            for motion in [[0.8, 0.0], [0.8, -3.0], [1.0, 3.0], [1.2, 3.0]] {
                assert_eq!(strikes(&[0.1], forward, motion), [false], "{motion:?}");
            }
        }
    }

    #[test]
    fn a_landing_is_no_edge() {
        for (grounded_s, expected) in [(0.0, false), (0.1, false), (0.2, true)] {
            let mut edge = Edge::default();
            for _ in 0..100 {
                edge.step(&rolling(1.0, 0.0), RADIUS_M, grounded_s, TICK_S);
            }
            let struck = edge.step(&rolling(0.8, 3.0), RADIUS_M, grounded_s, TICK_S);
            assert_eq!(struck, expected, "{grounded_s}");
        }
    }
}
