//! A jump: crouch, push off, fly with drawn-in legs, land on longer ones.

use super::{law::Ground, measured::Measured, ramp::Ramp, support::GRAVITY_MPS2};
use crate::{domain::BalanceProfile, kinematics::Leg, math::scalar};

/// Crouching: rate in m/s and longest time in s.
const CROUCH_MPS: f32 = 0.5;
const CROUCH_S: f32 = 0.6;
/// The legs are down when they are this close to their shortest length, in m.
const CLOSE_M: f32 = 0.018;
/// Part of the hips' torque that pushes off. The rest keeps the balance.
const PUSH_PART: f32 = 0.97;
/// Pushing off ends so much before the legs' full length, in m.
const PUSH_ENDS_BEFORE_M: f32 = 0.03;
const PUSH_S: f32 = 0.3;
/// Legs are drawn in for this part of the time up to the top.
const DRAWN_IN_PART: f32 = 1.3;
/// Rate in m/s at which legs are stretched to land, and the time in s for most of it. Before, the robot is in the air
/// whatever it feels.
pub const FLIGHT_MPS: f32 = 2.5;
const STRETCH_S: f32 = 0.05;
/// Time in s after which a robot that has pushed off has landed.
const FLIGHT_S: f32 = 1.0;
/// Legs are drawn in over an edge for this time in s to so much more than the shortest, in m, and then stretched to so much
/// more than it, in m, at this rate in m/s.
const HOP_S: f32 = 0.07;
const HOP_DRAWN_IN_M: f32 = 0.01;
const HOP_LANDS_M: f32 = 0.05;
const HOP_MPS: f32 = 1.0;

/// Parts of a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Crouch,
    Push,
    Flight {
        /// Speed upwards at take-off in m/s.
        start_mps: f32,
    },
    /// Over an edge that the wheels have struck.
    Hop,
}

/// A jump under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    part: Part,
    elapsed_s: f32,
}

/// What the legs do in a tick of a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legs {
    pub length: Ramp,
    pub push_n: Option<f32>,
    pub ground: Ground,
}

impl Jump {
    pub const START: Self = Self {
        part: Part::Crouch,
        elapsed_s: 0.0,
    };

    /// The wheels have struck an edge: they are lifted onto it.
    pub const OVER_EDGE: Self = Self {
        part: Part::Hop,
        elapsed_s: 0.0,
    };

    /// Returns `None` when the robot has landed.
    pub fn step(
        &mut self,
        profile: &BalanceProfile,
        measured: &Measured,
        airborne: bool,
        length: &Ramp,
        dt_s: f32,
    ) -> Option<Legs> {
        self.elapsed_s += dt_s;
        let limits = &profile.limits;
        let mut length = *length;
        let mut push_n = None;
        let mut ground = Ground::Touched;
        match &mut self.part {
            Part::Crouch => {
                length.step(limits.fold_length_m, CROUCH_MPS, dt_s);
                let down = measured.length_m() < limits.fold_length_m + CLOSE_M;
                if down || self.elapsed_s > CROUCH_S {
                    self.begin(Part::Push);
                }
            }
            Part::Push => {
                length = Ramp::at(measured.length_m());
                push_n = Some(push(limits.hip_nm, &measured.legs));
                let stretched = measured.length_m() > limits.reach_length_m - PUSH_ENDS_BEFORE_M;
                if stretched || self.elapsed_s > PUSH_S {
                    self.begin(Part::Flight {
                        start_mps: measured.length_mps(),
                    });
                }
            }
            Part::Flight { start_mps } => {
                // The axles are pulled along from the ground.
                let mass = &profile.mass;
                let rise_s = *start_mps * mass.carried_kg / (mass.total_kg * GRAVITY_MPS2);
                let drawn_in_s = DRAWN_IN_PART * rise_s;
                if self.elapsed_s < drawn_in_s {
                    length = Ramp::at(limits.fold_length_m);
                } else {
                    length.step(limits.max_length_m, FLIGHT_MPS, dt_s);
                }
                // Legs that stretch feel like legs that push.
                if self.elapsed_s < drawn_in_s + STRETCH_S {
                    ground = Ground::Left;
                } else if !airborne || self.elapsed_s > FLIGHT_S {
                    return None;
                }
            }
            Part::Hop => {
                if self.elapsed_s < HOP_S {
                    length = Ramp::at(limits.fold_length_m + HOP_DRAWN_IN_M);
                    ground = Ground::Left;
                } else {
                    ground = Ground::Felt;
                    length.step(limits.fold_length_m + HOP_LANDS_M, HOP_MPS, dt_s);
                    if !airborne || self.elapsed_s > FLIGHT_S {
                        return None;
                    }
                }
            }
        }
        Some(Legs {
            length,
            push_n,
            ground,
        })
    }

    fn begin(&mut self, part: Part) {
        *self = Self {
            part,
            elapsed_s: 0.0,
        };
    }
}

/// The push of each leg in N that its hips can give.
fn push(hip_nm: f32, legs: &[Leg; 2]) -> f32 {
    let mut least_n = f32::INFINITY;
    for leg in legs {
        for slope in leg.length_per_rad {
            least_n = scalar::min(least_n, PUSH_PART * hip_nm / scalar::max(slope.abs(), 0.02));
        }
    }
    least_n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::robots::FIVEBAR;

    /// Ticks of 1 ms over an edge: leg length in m and what is known of the ground in each.
    fn over_edge(airborne: bool) -> Vec<(f32, Ground)> {
        let measured = Measured::at_rest();
        let mut jump = Jump::OVER_EDGE;
        let mut length = Ramp::at(0.2);
        let mut ticks = Vec::new();
        while let Some(legs) = jump.step(&FIVEBAR.balance, &measured, airborne, &length, 0.001) {
            length = legs.length;
            assert_eq!(legs.push_n, None);
            ticks.push((legs.length.value, legs.ground));
            assert!(ticks.len() < 2_000, "it does not end");
        }
        ticks
    }

    #[test]
    fn wheels_that_strike_an_edge_are_drawn_in_for_a_moment() {
        let fold_m = FIVEBAR.balance.limits.fold_length_m;
        let ticks = over_edge(false);
        assert!((68..=71).contains(&ticks.len()), "{}", ticks.len());
        assert!(
            ticks
                .iter()
                .all(|(length_m, ground)| *length_m < fold_m + 0.02 && *ground == Ground::Left)
        );
    }

    #[test]
    fn in_flight_the_legs_are_as_short_as_they_can_be() {
        let mut jump = Jump {
            part: Part::Flight { start_mps: 2.0 },
            elapsed_s: 0.0,
        };
        let length = Ramp::at(0.2);
        let legs = jump.step(&FIVEBAR.balance, &Measured::at_rest(), true, &length, 0.001);
        let length_m = legs.map(|legs| legs.length.value);
        assert_eq!(length_m, Some(FIVEBAR.balance.limits.fold_length_m));
    }

    #[test]
    fn in_the_air_the_legs_stretch_again_until_a_flight_is_over() {
        let fold_m = FIVEBAR.balance.limits.fold_length_m;
        let ticks = over_edge(true);
        assert!((998..=1_001).contains(&ticks.len()), "{}", ticks.len());
        let (length_m, ground) = ticks[500];
        assert!((length_m - fold_m - 0.05).abs() < 0.005, "{length_m}");
        assert_eq!(ground, Ground::Felt);
    }
}
