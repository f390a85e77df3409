//! The orientation of the board (docs/mounting.md).

use serde::Deserialize;

const DIRECTIONS: [&str; 6] = ["forward", "backward", "left", "right", "up", "down"];

/// Where the sensor's axes x and z point in the robot, such as `x-forward-z-up`.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Mounting(String);

impl Mounting {
    /// Its name, such as `x-forward-z-up`.
    pub fn name(&self) -> &str {
        &self.0
    }

    /// The sensor's axes x, y and z as seen from the body.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        let words = self
            .0
            .strip_prefix("x-")
            .and_then(|it| it.split_once("-z-"));
        let (x, z) = words.map_or_else(Default::default, |(x, z)| (direction(x), direction(z)));
        let y = [
            z[1] * x[2] - z[2] * x[1],
            z[2] * x[0] - z[0] * x[2],
            z[0] * x[1] - z[1] * x[0],
        ];
        [x, y, z]
    }
}

/// The direction of one of the words, in body axes.
fn direction(word: &str) -> [f64; 3] {
    match word {
        "forward" => [1.0, 0.0, 0.0],
        "backward" => [-1.0, 0.0, 0.0],
        "left" => [0.0, 1.0, 0.0],
        "right" => [0.0, -1.0, 0.0],
        "up" => [0.0, 0.0, 1.0],
        _ => [0.0, 0.0, -1.0],
    }
}

/// A text that names no [`Mounting`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no mounting; write where the axes x and z point, at right angles, such as `x-forward-z-up` (forward, \
     backward, left, right, up, down)"
)]
pub struct UnknownMounting(String);

impl TryFrom<String> for Mounting {
    type Error = UnknownMounting;

    fn try_from(text: String) -> Result<Self, UnknownMounting> {
        let words = text.strip_prefix("x-").and_then(|it| it.split_once("-z-"));
        let index = |word| DIRECTIONS.iter().position(|it| *it == word);
        let is_right_angled = words
            .and_then(|(x, z)| Some((index(x)?, index(z)?)))
            .is_some_and(|(x, z)| x / 2 != z / 2);
        if is_right_angled {
            Ok(Self(text))
        } else {
            Err(UnknownMounting(text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_handed() {
        let mounting = Mounting::try_from("x-left-z-up".to_owned()).expect("it is one");
        let expected = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(mounting.axes(), expected);
    }
}
