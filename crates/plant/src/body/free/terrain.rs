//! The ground, as a course along +x. The robot starts at x = 0, y = 0 on level ground at z = 0.

use crate::random::{Random, Stream};
use serde::Deserialize;

/// Steepest angle of a slope or ramp.
const STEEPEST_RAD: f64 = 1.05;
/// No course reaches or rises farther.
const FARTHEST_M: f64 = 1e3;
const MOST_PLATES: u8 = 64;
/// A ramp that rises less would be longer than any course.
const FLATTEST_RAMP_RAD: f64 = 0.01;
const MOST_TILT_RAD: f64 = 1.0;

/// A course. Lengths along x unless said otherwise; everything is as wide as the world, unless said otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Terrain {
    /// Level ground.
    #[default]
    Flat,
    /// Level, then rising at a constant angle (falling where it is negative), then level again.
    Slope {
        /// Where the slope begins.
        start_m: f64,
        /// Angle from level, upward positive, below 60° either way.
        angle_rad: f64,
        /// Length of the slope, along x.
        length_m: f64,
    },
    /// A ramp under the left wheel only (y > 0): up, level, down.
    OneSidedRamp {
        /// Where the ramp begins.
        start_m: f64,
        /// Angle of its two slopes, from 0.01 rad to 60°.
        angle_rad: f64,
        /// Height of its top.
        height_m: f64,
        /// Length of its top.
        top_m: f64,
    },
    /// A step up, or down where the height is negative.
    Step {
        /// Where the edge is.
        at_m: f64,
        /// Height of the ground behind it.
        height_m: f64,
    },
    /// A gap across the way.
    Gap {
        /// Its near edge.
        at_m: f64,
        /// Its width.
        width_m: f64,
        /// Its depth.
        depth_m: f64,
    },
    /// Plates one after the other, each with its own height and tilt, different under the left and the right wheel.
    Plates {
        /// Where the first begins.
        start_m: f64,
        /// Number of plates, at most 64.
        count: u8,
        /// Length of each.
        length_m: f64,
        /// Greatest height of a plate's middle above the ground.
        height_m: f64,
        /// Greatest tilt about y, either way, at most 1 rad.
        tilt_rad: f64,
        /// Seed of heights and tilts.
        seed: u64,
    },
    /// Level ground with a strip of another friction.
    Slippery {
        /// Where the strip begins.
        start_m: f64,
        /// Its length.
        length_m: f64,
        /// Factor on the friction coefficient.
        grip: f64,
    },
}

/// Points (x, z) of the ground from one end to the other. It is level before the first and behind the last, and at z = 0
/// where there is none.
pub type Corners = Vec<[f64; 2]>;

impl Terrain {
    /// The ground under the left and the right wheel.
    pub fn corners(&self) -> [Corners; 2] {
        let both = |corners: Corners| [corners.clone(), corners];
        match *self {
            Self::Flat | Self::Slippery { .. } => both(Vec::new()),
            Self::Slope {
                start_m,
                angle_rad,
                length_m,
            } => {
                let length_m = length_m.clamp(0.0, FARTHEST_M);
                let rise_m = length_m * angle_rad.clamp(-STEEPEST_RAD, STEEPEST_RAD).tan();
                both(vec![[start_m, 0.0], [start_m + length_m, rise_m]])
            }
            Self::OneSidedRamp {
                start_m,
                angle_rad,
                height_m,
                top_m,
            } => {
                let run_m = height_m.abs() / angle_rad.clamp(FLATTEST_RAMP_RAD, STEEPEST_RAD).tan();
                let ramp = vec![
                    [start_m, 0.0],
                    [start_m + run_m, height_m],
                    [start_m + (run_m + top_m), height_m],
                    [start_m + (2.0 * run_m + top_m), 0.0],
                ];
                [ramp, Vec::new()]
            }
            Self::Step { at_m, height_m } => both(vec![[at_m, 0.0], [at_m, height_m]]),
            Self::Gap {
                at_m,
                width_m,
                depth_m,
            } => both(vec![
                [at_m, 0.0],
                [at_m, -depth_m],
                [at_m + width_m, -depth_m],
                [at_m + width_m, 0.0],
            ]),
            Self::Plates {
                start_m,
                count,
                length_m,
                height_m,
                tilt_rad,
                seed,
            } => {
                let mut random = Random::new(seed, Stream::Plates);
                let count = count.min(MOST_PLATES);
                // A plate ends in exactly the number with which the next one starts.
                let edge_m = |plate: u8| start_m + f64::from(plate) * length_m;
                let mut side = || {
                    let mut corners = vec![[start_m, 0.0]];
                    for plate in 0..count {
                        let middle_m = height_m * random.unit();
                        let tilt_rad = random.symmetric(tilt_rad);
                        let rise_m =
                            length_m / 2.0 * tilt_rad.clamp(-MOST_TILT_RAD, MOST_TILT_RAD).tan();
                        // No plate digs into the ground.
                        let above_m = |z: f64| (middle_m + z).max(0.0);
                        corners.push([edge_m(plate), above_m(-rise_m)]);
                        corners.push([edge_m(plate + 1), above_m(rise_m)]);
                    }
                    corners.push([edge_m(count), 0.0]);
                    corners
                };
                [side(), side()]
            }
        }
    }

    /// Whether a robot can meet this ground: every number within the range of its meaning, and nothing that leads back along x.
    pub fn is_sound(&self) -> bool {
        // Corners come of numbers that are already within their limits.
        self.is_as_said()
            && self.corners().iter().all(|corners| {
                corners.iter().flatten().all(|it| it.abs() <= FARTHEST_M)
                    && corners.is_sorted_by(|a, b| a[0] <= b[0])
            })
    }

    /// Whether the ground will be as these numbers say. None of them is NaN then.
    fn is_as_said(&self) -> bool {
        let any = |it: f64| it.abs() <= FARTHEST_M;
        let length = |it: f64| (0.0..=FARTHEST_M).contains(&it);
        match *self {
            Self::Flat => true,
            Self::Slope {
                start_m,
                angle_rad,
                length_m,
            } => any(start_m) && angle_rad.abs() <= STEEPEST_RAD && length(length_m),
            Self::OneSidedRamp {
                start_m,
                angle_rad,
                height_m,
                top_m,
            } => {
                let angles = FLATTEST_RAMP_RAD..=STEEPEST_RAD;
                any(start_m) && angles.contains(&angle_rad) && any(height_m) && length(top_m)
            }
            Self::Step { at_m, height_m } => any(at_m) && any(height_m),
            Self::Gap {
                at_m,
                width_m,
                depth_m,
            } => any(at_m) && length(width_m) && any(depth_m),
            Self::Plates {
                start_m,
                count,
                length_m,
                height_m,
                tilt_rad,
                seed: _,
            } => {
                let tilts = 0.0..=MOST_TILT_RAD;
                any(start_m)
                    && count <= MOST_PLATES
                    && length(length_m)
                    && length(height_m)
                    && tilts.contains(&tilt_rad)
            }
            Self::Slippery {
                start_m,
                length_m,
                grip,
            } => any(start_m) && length(length_m) && (0.0..=2.0).contains(&grip),
        }
    }
}
