//! The orientation of a sensor in its carrier, the board or the robot.

use std::str::FromStr;

/// Directions of the sensor's x, y and z axes, as unit vectors in the carrier's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting {
    axes: [[f64; 3]; 3],
}

/// A text that names no [`Mounting`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no mounting; write where the axes x and z point, at right angles, such as `x-forward-z-up` (forward, \
     backward, left, right, up, down)"
)]
pub struct UnknownMounting(String);

impl Default for Mounting {
    /// x forward, z up.
    fn default() -> Self {
        Self {
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }
}

impl FromStr for Mounting {
    type Err = UnknownMounting;

    fn from_str(text: &str) -> Result<Self, UnknownMounting> {
        let axes = || {
            let (x, z) = text.strip_prefix("x-")?.split_once("-z-")?;
            let (x, z) = (direction(x)?, direction(z)?);
            let y = cross(z, x);
            (y != [0.0; 3]).then_some([x, y, z])
        };
        let axes = axes().ok_or_else(|| UnknownMounting(text.to_owned()))?;
        Ok(Self { axes })
    }
}

impl Mounting {
    /// That of the board in a robot.
    pub(crate) fn of(imu: &robot_description::Imu) -> Self {
        let name = imu.mounting.name().parse();
        name.expect("a robot's file knows the same names")
    }

    /// Converts a vector from the carrier's axes to the sensor's axes.
    pub(crate) fn to_sensor(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.axes
            .map(|axis| axis[0] * x + axis[1] * y + axis[2] * z)
    }
}

fn direction(word: &str) -> Option<[f64; 3]> {
    Some(match word {
        "forward" => [1.0, 0.0, 0.0],
        "backward" => [-1.0, 0.0, 0.0],
        "left" => [0.0, 1.0, 0.0],
        "right" => [0.0, -1.0, 0.0],
        "up" => [0.0, 0.0, 1.0],
        "down" => [0.0, 0.0, -1.0],
        _ => return None,
    })
}

fn cross([ax, ay, az]: [f64; 3], [bx, by, bz]: [f64; 3]) -> [f64; 3] {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(name: &str, carrier: [f64; 3]) -> [f64; 3] {
        let mounting: Mounting = name.parse().expect("a mounting");
        // Adding 0.0 turns −0.0 into 0.0.
        mounting.to_sensor(carrier).map(|axis| axis + 0.0)
    }

    #[test]
    fn a_sensor_measures_along_its_own_axes() {
        let nose_left_top = [1.0, 2.0, 3.0];
        assert_eq!(measured("x-forward-z-up", nose_left_top), nose_left_top);
        assert_eq!(
            measured("x-forward-z-down", nose_left_top),
            [1.0, -2.0, -3.0]
        );
        assert_eq!(measured("x-left-z-up", nose_left_top), [2.0, -1.0, 3.0]);
        assert_eq!(
            measured("x-down-z-forward", nose_left_top),
            [-3.0, 2.0, 1.0]
        );
        assert_eq!(measured("x-up-z-left", nose_left_top), [3.0, 1.0, 2.0]);
        let default = Mounting::default();
        assert_eq!("x-forward-z-up".parse(), Ok(default));
    }

    #[test]
    fn the_error_names_a_text_that_is_no_mounting() {
        for name in [
            "x-forward-z-backward",
            "x-up-z-up",
            "z-up",
            "x-front-z-up",
            "",
        ] {
            let error = name.parse::<Mounting>().expect_err("none");
            assert!(error.to_string().starts_with(&format!("`{name}` is no")));
        }
    }
}
