//! What an episode may hold.

use crate::GymError;

/// How an episode begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StartKind {
    /// Sitting in half of the episodes, else standing.
    #[default]
    Mixed,
    /// As after switching off: legs folded, at rest.
    Sitting,
    /// On its wheels at the middle of the legs' range, tilted and moving a little.
    Standing,
}

/// Options of an environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How episodes begin.
    pub start: StartKind,
    /// Whether the robot's own balance controller drives, and not the actions: to compare with. Episodes begin sitting.
    pub built_in: bool,
    /// Whether the robot differs from its file: mass −20 … +40 %, centre of mass ±3 cm, friction 0.4 … 1.2, torque ±10 %,
    /// up to 5 ms more delay, the board turned by up to 1°. Sensors have noise anyway.
    pub vary: bool,
    /// Greatest change of speed in m/s by a push. 0: no pushes.
    pub push_mps: f64,
    /// Times in s between pushes.
    pub push_every_s: [f64; 2],
    /// Greatest speed commanded in m/s.
    pub speed_mps: f64,
    /// Greatest turn rate commanded in rad/s.
    pub turn_rps: f64,
    /// Times in s between new commands.
    pub command_every_s: [f64; 2],
    /// Length of an episode in s, after which a [`Fleet`](crate::Fleet) truncates it.
    pub episode_s: f64,
    /// Episodes after which another robot is drawn.
    pub episodes_per_robot: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            start: StartKind::Mixed,
            built_in: false,
            vary: true,
            push_mps: 1.5,
            push_every_s: [2.0, 5.0],
            speed_mps: 1.5,
            turn_rps: 3.0,
            command_every_s: [2.0, 5.0],
            episode_s: 10.0,
            episodes_per_robot: 20,
        }
    }
}

impl Options {
    /// Checks the ranges.
    ///
    /// # Errors
    /// A value is out of its range.
    pub fn check(&self) -> Result<(), GymError> {
        let [push_early, push_late] = self.push_every_s;
        let [command_early, command_late] = self.command_every_s;
        for (name, value, least, most) in [
            ("push_mps", self.push_mps, 0.0, 5.0),
            ("push_every_s[0]", push_early, 0.1, push_late),
            ("push_every_s[1]", push_late, 0.1, 1e6),
            ("speed_mps", self.speed_mps, 0.0, 2.5),
            ("turn_rps", self.turn_rps, 0.0, 8.0),
            ("command_every_s[0]", command_early, 0.1, command_late),
            ("command_every_s[1]", command_late, 0.1, 1e6),
            ("episode_s", self.episode_s, 0.1, 1e6),
            (
                "episodes_per_robot",
                self.episodes_per_robot.into(),
                1.0,
                f64::from(u32::MAX),
            ),
        ] {
            if !(least..=most).contains(&value) {
                return Err(GymError::Option {
                    name,
                    value,
                    least,
                    most,
                });
            }
        }
        Ok(())
    }
}
