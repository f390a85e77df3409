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
