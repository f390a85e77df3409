//! What a free robot is made of beside its file: variation, start, ground.

use super::Terrain;
use serde::Deserialize;

/// How one robot differs from its file. The default is the robot of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Factor on the whole robot's mass. The body takes the difference, and its inertia grows as its mass does.
    pub mass_factor: f64,
    /// Shift of the body's centre of mass, in body axes.
    pub com_offset_m: [f64; 3],
    /// Coulomb friction coefficient of tyres and body on the ground.
    pub ground_friction: f64,
}

impl Default for Variation {
    fn default() -> Self {
        Self {
            mass_factor: 1.0,
            com_offset_m: [0.0; 3],
            // Rubber on a clean floor, an assumption.
            ground_friction: 0.8,
        }
    }
}

/// Pose in which the robot is released.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Upright on its wheels at the middle of the leg's range, centre of mass above the axles. Nothing holds it.
    Standing,
    /// At rest as after switching off: legs folded, on its wheels and an edge of the body.
    #[default]
    Sitting,
    /// At rest on its front.
    Front,
    /// At rest on its back.
    Back,
    /// At rest on its left side.
    Left,
    /// At rest on its right side.
    Right,
    /// Upright on folded legs, released at once.
    Folded,
    /// At rest upside down.
    UpsideDown,
    /// As standing, with the wheels above the ground.
    Dropped {
        /// Height of the tyres above the ground.
        height_m: f64,
    },
}

/// What holds the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// Nothing.
    #[default]
    Free,
    /// The body is fixed in the world; legs and wheels move.
    Clamped,
}

/// Everything that [`FreeBody::new`](super::FreeBody::new) needs beside the robot.
#[derive(Clone, Debug, Default)]
pub struct FreeSetup {
    /// Departures from the robot's file.
    pub variation: Variation,
    /// Pose at the start.
    pub start: Start,
    /// The ground.
    pub terrain: Terrain,
    /// What holds the body.
    pub hold: Hold,
}
