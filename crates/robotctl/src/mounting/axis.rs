//! Describes axes and where they point.

use std::fmt;

use nalgebra::Vector3;
use robot_app::domain::Orientation;

/// An axis of a sensor, or its opposite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// Number of the axis: 0 for x, 1 for y, 2 for z.
    index: usize,
    positive: bool,
}

const NAMES: [&str; 3] = ["x", "y", "z"];

impl Axis {
    /// Returns the axis that is nearest to `direction`.
    pub fn nearest(direction: Vector3<f64>) -> Self {
        let index = direction.iamax();
        Self {
            index,
            positive: direction[index] > 0.0,
        }
    }

    pub fn unit(self) -> Vector3<f64> {
        let mut unit = Vector3::zeros();
        unit[self.index] = if self.positive { 1.0 } else { -1.0 };
        unit
    }

    pub fn is_along(self, other: Self) -> bool {
        self.index == other.index
    }

    /// Returns the angle between this axis and `direction`.
    pub fn degrees_to(self, direction: Vector3<f64>) -> f64 {
        self.unit().angle(&direction).to_degrees()
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.positive { "" } else { "-" };
        write!(f, "{sign}{}", NAMES[self.index])
    }
}

/// Returns words such as `x points left, y backward, z up`.
pub fn describe(orientation: Orientation) -> String {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .map(|axis| direction(orientation.rotate(axis)));
    format!("x points {x}, y {y}, z {z}")
}

fn direction([forward, left, up]: [f32; 3]) -> &'static str {
    if forward != 0.0 {
        ["backward", "forward"][usize::from(forward > 0.0)]
    } else if left != 0.0 {
        ["right", "left"][usize::from(left > 0.0)]
    } else {
        ["down", "up"][usize::from(up > 0.0)]
    }
}
