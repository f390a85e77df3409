//! The two ways to steer: wheels and joints one by one, or in place of the sticks.

use robotctl::{
    can_link::CanLinkError,
    drive::{Driver, RobotView, SticksDriver, Wish},
    pc_link::PcLink,
};

use super::signed::signed;

pub enum Pilot {
    /// Speeds of the wheels, and joints that hold their angle.
    Motors(Driver),
    /// What sticks would say to the robot's own controller.
    Sticks(SticksDriver),
}

impl Pilot {
    /// Sends the command for `dt_s` after the one before.
    pub fn step(
        &mut self,
        link: &mut PcLink,
        dt_s: f64,
        wish: Wish,
        robot: &RobotView,
    ) -> Result<(), CanLinkError> {
        match self {
            Self::Motors(driver) => link.command(&driver.step(dt_s, wish, robot)),
            Self::Sticks(driver) => link.drive(&driver.step(dt_s, wish, robot)),
        }
    }

    /// Sends a command from rest.
    pub fn rest(&mut self, link: &mut PcLink, robot: &RobotView) -> Result<(), CanLinkError> {
        match self {
            Self::Motors(driver) => link.command(&driver.rest(robot)),
            Self::Sticks(driver) => link.drive(&driver.rest()),
        }
    }

    /// Returns true while a held dead-man has no effect, because it was held through a stop.
    pub fn must_let_go(&self) -> bool {
        match self {
            Self::Motors(driver) => driver.must_let_go(),
            Self::Sticks(driver) => driver.must_let_go(),
        }
    }

    /// Returns true if the robot takes none of these commands while it stands.
    pub fn needs_a_sitting_robot(&self) -> bool {
        matches!(self, Self::Motors(_))
    }

    /// Returns lines on what is wanted and what the robot does.
    pub fn lines(&self, robot: &RobotView) -> Vec<String> {
        let [left_is, right_is, ..] = robot.state.motors;
        match self {
            Self::Motors(driver) => {
                let (forward_mps, turn_rps) = driver.targets();
                let [left, right] = driver.wheel_targets_rps();
                vec![
                    format!(
                        "target    forward {} m/s, turn {} rad/s (left positive)",
                        signed(forward_mps),
                        signed(turn_rps)
                    ),
                    format!(
                        "wheels    left {} (target {}), right {} (target {}) rad/s",
                        signed(left_is.vel_rps.into()),
                        signed(left),
                        signed(right_is.vel_rps.into()),
                        signed(right)
                    ),
                ]
            }
            Self::Sticks(driver) => {
                let [forward, turn, height, roll] = driver.shares().map(signed);
                vec![
                    format!(
                        "sticks    forward {forward}, turn {turn} (left positive), height {height}, roll {roll} of the most"
                    ),
                    format!(
                        "wheels    left {}, right {} rad/s",
                        signed(left_is.vel_rps.into()),
                        signed(right_is.vel_rps.into()),
                    ),
                ]
            }
        }
    }
}
