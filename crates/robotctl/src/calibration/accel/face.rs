//! The six sides of the robot that can point upwards.

use nalgebra::Vector3;

use super::StillWindow;

/// Least share of the measurement along the axis, which means within 30° of it.
const MIN_SHARE: f64 = 0.866;

/// The side that points upwards, in the body frame (x forward, y left, z up).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
}

impl Face {
    pub const ALL: [Self; 6] = [
        Self::Top,
        Self::Bottom,
        Self::Left,
        Self::Right,
        Self::Front,
        Self::Back,
    ];

    /// Returns the side that the measured acceleration points at, or `None` if the robot stood on an edge.
    pub fn up(mean_mps2: Vector3<f64>) -> Option<Self> {
        let direction = mean_mps2.normalize();
        let axis = direction.iamax();
        let (positive, negative) = [
            (Self::Front, Self::Back),
            (Self::Left, Self::Right),
            (Self::Top, Self::Bottom),
        ][axis];
        let face = if direction[axis] > 0.0 {
            positive
        } else {
            negative
        };
        (direction[axis].abs() >= MIN_SHARE).then_some(face)
    }

    pub fn describe(self) -> &'static str {
        match self {
            Self::Front => "front up (+x)",
            Self::Back => "back up (-x)",
            Self::Left => "left side up (+y)",
            Self::Right => "right side up (-y)",
            Self::Top => "top up (+z)",
            Self::Bottom => "upside down (-z)",
        }
    }
}

pub(super) fn missing(windows: &[StillWindow]) -> Vec<Face> {
    let seen: Vec<_> = windows
        .iter()
        .filter_map(|w| Face::up(w.mean_mps2))
        .collect();
    Face::ALL
        .into_iter()
        .filter(|face| !seen.contains(face))
        .collect()
}

pub(super) fn list(faces: &[Face]) -> String {
    let names: Vec<_> = faces.iter().map(|f| f.describe()).collect();
    names.join(", ")
}
