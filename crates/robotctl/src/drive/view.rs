//! What the PC knows of the robot.

use robot_app::link::{Keys, Uplink};

use super::Obstacle;
use crate::{link_recorder::Mode, tuning::LiveReading};

/// The last state of the robot, and its answers on the tuning channel.
#[derive(Clone, Debug, Default)]
pub struct RobotView {
    pub state: Uplink,
    blockers: Vec<String>,
    flags: Vec<String>,
    is_stopped: bool,
    stands: bool,
}

impl RobotView {
    /// Takes a reading of the live pages `arming`, `safety` or `balance`; others say nothing here.
    pub fn take(&mut self, reading: &LiveReading) {
        match reading.page.name {
            "arming" => self.blockers = reading.set("blockers"),
            "safety" => {
                self.flags = reading.set("flags");
                self.is_stopped = reading.choice("verdict") != "run";
            }
            "balance" => self.stands = reading.choice("state") != "sit",
            _ => {}
        }
    }

    pub fn is_armed(&self) -> bool {
        self.state.keys.contains(Keys::F1)
    }

    /// True if the robot stands, or does something else than sit.
    pub fn stands(&self) -> bool {
        self.stands
    }

    pub fn mode(&self) -> Option<Mode> {
        Mode::chosen(self.state.keys)
    }

    /// Returns what has to change before the robot moves, or `None` if it follows the PC.
    pub fn obstacle(&self) -> Option<Obstacle> {
        let has = |flag: &str| self.flags.iter().any(|name| name == flag);
        if self.state.keys.contains(Keys::F2) {
            return Some(Obstacle::RadioLost);
        }
        match self.mode() {
            None => return Some(Obstacle::RadioLost),
            Some(Mode::Pc) => {}
            Some(other) => return Some(Obstacle::NotPc(other)),
        }
        if !self.is_armed() {
            return Some(Obstacle::Disarmed(self.blockers.clone()));
        }
        if has("pc-lost") {
            return Some(Obstacle::PcLost);
        }
        if has("pc-awaited") {
            return Some(Obstacle::PcAwaited);
        }
        self.is_stopped
            .then(|| Obstacle::Stopped(self.flags.clone()))
    }
}
