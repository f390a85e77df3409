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
    balance: Option<String>,
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
            "balance" => self.balance = Some(reading.choice("state")),
            _ => {}
        }
    }

    pub fn is_armed(&self) -> bool {
        self.state.keys.contains(Keys::F1)
    }

    /// What the balance controller does, in the firmware's words. `None` before the first reading.
    pub fn balance(&self) -> Option<&str> {
        self.balance.as_deref()
    }

    /// True if the robot stands, or is on its way up or down.
    pub fn stands(&self) -> bool {
        matches!(
            self.balance(),
            Some("stand-up" | "balance" | "jump" | "sit-down")
        )
    }

    /// True if the robot has fallen or lies so that it cannot stand up.
    pub fn lies(&self) -> bool {
        matches!(self.balance(), Some("fallen" | "cannot-rise"))
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

#[cfg(test)]
mod tests {
    use robot_app::domain::BalanceState;

    use super::*;
    use crate::tuning::{live_page, testing};

    #[test]
    fn a_robot_that_lies_does_not_stand() {
        use BalanceState::{Balance, CannotRise, Fallen, Jump, Sit, SitDown, StandUp};
        let (bus, mut client) = testing::robot();
        let mut view = RobotView::default();
        assert_eq!(
            (view.balance(), view.stands(), view.lies()),
            (None, false, false)
        );
        for (state, word, stands, lies) in [
            (Sit, "sit", false, false),
            (StandUp, "stand-up", true, false),
            (Balance, "balance", true, false),
            (Jump, "jump", true, false),
            (SitDown, "sit-down", true, false),
            (Fallen, "fallen", false, true),
            (CannotRise, "cannot-rise", false, true),
        ] {
            bus.0.borrow_mut().diagnostics.balance.state = state;
            let reading = client.live(live_page("balance"), 0).expect("an answer");
            view.take(&reading.expect("the page"));
            assert_eq!(
                (view.balance(), view.stands(), view.lies()),
                (Some(word), stands, lies)
            );
        }
    }
}
