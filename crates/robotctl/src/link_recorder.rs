//! Records the robot's state from the PC link as MCAP. Its time is the robot's.

mod message;
mod robot_time;

use std::path::Path;

use robot_app::link::{ScanCounters, Uplink};

use crate::{
    mcap_file::{McapFile, McapFileError, Topic},
    pc_link::Traffic,
};
pub use message::{
    Attitude, Gap, Joints, LinkCounters, Mode, Motor, Radio, State, Wheels, transform,
};
use robot_time::{Arrival, RobotTime};

/// Topic of the robot's state, one message a frame.
pub const STATE_TOPIC: &str = "/state";
/// Topic of the link's counters, ten messages a second.
pub const LINK_TOPIC: &str = "/link";
/// Topic of the gaps, each at the time of the first frame after it.
pub const GAP_TOPIC: &str = "/link/gap";
/// Topic of the attitude for viewers in three dimensions.
const TRANSFORM_TOPIC: &str = "/tf";

/// Time from one state frame to the next.
pub const STATE_PERIOD_S: f64 = 0.0024;
/// A longer time without a state frame is a gap. The link sends tunnelled frames between state frames, so some come late.
pub const GAP_S: f64 = 4.0 * STATE_PERIOD_S;
const STATISTICS_S: f64 = 0.1;
const TRANSFORM_S: f64 = 0.02;
const NS_A_SECOND: f64 = 1e9;

/// Writes the robot's state to a file.
pub struct LinkRecorder {
    file: McapFile,
    topics: Topics,
    time: RobotTime,
    summary: LinkSummary,
    statistics_at_s: f64,
    transform_at_s: f64,
}

struct Topics {
    state: Topic,
    link: Topic,
    gap: Topic,
    transform: Topic,
}

/// What was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkSummary {
    /// State frames.
    pub states: u64,
    /// Frames with values that no robot sends, or whose time contradicts those around it. They were damaged, and their
    /// CRC fits by chance.
    pub implausible: u64,
    /// How often the robot's time began again.
    pub restarts: u64,
    pub gaps: u64,
    pub longest_gap_s: f64,
    /// Time that the gaps take.
    pub missing_s: f64,
    /// Time from the first frame to the last.
    pub duration_s: f64,
    /// What the receiver has counted since its first good frame.
    pub counters: ScanCounters,
}

impl LinkSummary {
    pub fn rate_hz(&self) -> f64 {
        self.states.saturating_sub(1) as f64 / self.duration_s.max(1e-9)
    }
}

impl LinkRecorder {
    pub fn create(path: &Path) -> Result<Self, McapFileError> {
        let mut file = McapFile::create(path)?;
        let topics = Topics {
            state: file.add_topic(STATE_TOPIC, "jiling.State", &message::state_schema())?,
            link: file.add_topic(LINK_TOPIC, "jiling.Link", &message::link_schema())?,
            gap: file.add_topic(GAP_TOPIC, "jiling.Gap", &message::gap_schema())?,
            transform: file.add_topic(
                TRANSFORM_TOPIC,
                "foxglove.FrameTransform",
                &message::transform_schema(),
            )?,
        };
        Ok(Self {
            file,
            topics,
            time: RobotTime::default(),
            summary: LinkSummary::default(),
            statistics_at_s: f64::NEG_INFINITY,
            transform_at_s: f64::NEG_INFINITY,
        })
    }

    /// Records a state frame. `traffic` is what came through the port up to it.
    pub fn add(&mut self, state: &Uplink, traffic: &Traffic) -> Result<(), McapFileError> {
        self.summary.counters = traffic.counters;
        for arrival in self.time.add(state) {
            self.add_arrival(&arrival)?;
        }
        self.summary.implausible = traffic.implausible + self.time.implausible();
        Ok(())
    }

    fn add_arrival(&mut self, arrival: &Arrival) -> Result<(), McapFileError> {
        let t_s = arrival.t_s;
        let time_ns = nanoseconds(t_s);
        self.summary.states += 1;
        self.summary.duration_s = t_s - self.time.first_s().unwrap_or(t_s);
        self.summary.restarts += u64::from(arrival.restarted);
        if arrival.after_s > GAP_S {
            self.summary.gaps += 1;
            self.summary.missing_s += arrival.after_s - STATE_PERIOD_S;
            self.summary.longest_gap_s = self.summary.longest_gap_s.max(arrival.after_s);
        }
        if arrival.after_s > GAP_S || arrival.restarted {
            let gap = Gap {
                seconds: arrival.after_s,
                restarted: arrival.restarted,
            };
            self.file.write(self.topics.gap, time_ns, &gap)?;
        }
        let message = State::new(&arrival.state, t_s);
        self.file.write(self.topics.state, time_ns, &message)?;
        if t_s >= self.transform_at_s {
            self.transform_at_s = t_s + TRANSFORM_S;
            let transform = message::transform(arrival.state.q_xyzw, time_ns);
            self.file
                .write(self.topics.transform, time_ns, &transform)?;
        }
        if t_s >= self.statistics_at_s {
            self.statistics_at_s = t_s + STATISTICS_S;
            let link = LinkCounters::new(&self.summary);
            self.file.write(self.topics.link, time_ns, &link)?;
        }
        Ok(())
    }

    pub fn summary(&self) -> &LinkSummary {
        &self.summary
    }

    /// Completes the file.
    pub fn finish(self) -> Result<LinkSummary, McapFileError> {
        self.file.finish()?;
        Ok(self.summary)
    }
}

fn nanoseconds(t_s: f64) -> u64 {
    (t_s * NS_A_SECOND).round() as u64
}

#[cfg(test)]
mod tests;
