//! Whose clock gives the cycles.

use std::{
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use anyhow::{Result, bail};
use robot_policy::pace::{Pace, RobotPace};

use super::{super::super::priority, Session, link_failed};

/// A robot in lockstep that takes longer for its next state is gone.
const PATIENCE: Duration = Duration::from_secs(30);
/// Who waits for a state asks this often whether the user wants to end.
const SLICE: Duration = Duration::from_millis(100);

/// Gives the cycles.
pub enum Beat {
    /// The computer's clock: real time.
    Computer(Pace),
    /// The clock of a robot that waits for an answer to each of its states.
    Robot(RobotPace),
}

/// The start of a cycle.
pub struct Begun {
    /// Time in s by the clock that counts.
    pub time_s: f64,
    /// How late it is.
    pub late: Duration,
    /// Time in s since the newest state came; in lockstep, for how long it did not come.
    pub age_s: f64,
}

impl Beat {
    /// Takes the computer's clock, or the robot's.
    pub fn new(period: Duration, is_in_lockstep: bool) -> Self {
        if is_in_lockstep {
            Self::Robot(RobotPace::new(period))
        } else {
            Self::Computer(Pace::new(period, Instant::now()))
        }
    }

    /// Prepares the computer, and says whose clock counts.
    pub fn prepare(&self) -> String {
        match self {
            Self::Computer(_) => priority::raise(),
            Self::Robot(_) => "in lockstep: the robot's clock counts".to_owned(),
        }
    }

    /// Waits until a cycle is due.
    pub fn begin(&mut self, session: &mut Session) -> Result<Begun> {
        match self {
            Self::Computer(pace) => {
                session.listen(pace.due())?;
                let now = Instant::now();
                let since = |instant| now.duration_since(instant).as_secs_f64();
                Ok(Begun {
                    time_s: since(session.started),
                    late: pace.begin(now),
                    age_s: session.heard.map_or(f64::INFINITY, since),
                })
            }
            Self::Robot(pace) => loop {
                wait_for_state(session)?;
                let time_s = f64::from(session.robot.state.time_s);
                let age_s = pace.hear(time_s);
                if let Some(late) = pace.begin(time_s) {
                    return Ok(Begun {
                        time_s,
                        late,
                        age_s,
                    });
                }
                // The robot waits for an answer to each state.
                let command = session.command;
                session.link.command(&command).map_err(link_failed)?;
            },
        }
    }
}

/// Waits for the next state of a robot in lockstep.
fn wait_for_state(session: &mut Session) -> Result<()> {
    let gone = Instant::now() + PATIENCE;
    while !session.next_state(Instant::now() + SLICE)? {
        if session.interrupted.load(Ordering::Relaxed) {
            bail!("ended as asked, while the robot in lockstep sent no state");
        }
        if Instant::now() > gone {
            bail!("the robot in lockstep sends no more states: was its program stopped?");
        }
    }
    Ok(())
}
