//! The ground, as a course along +x. The robot starts at x = 0, y = 0 on level ground at z = 0.

use serde::Deserialize;

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
        /// Angle of its two slopes.
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
        /// Greatest tilt about y, either way.
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
