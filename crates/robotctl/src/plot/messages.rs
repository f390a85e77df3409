//! Reads the messages of a recording.

use std::collections::{BTreeMap, BTreeSet};

use mcap::{McapError, MessageStream, read::Options};
use serde::Deserialize;

use crate::link_recorder::{LINK_TOPIC, LinkCounters, STATE_TOPIC, State};

const NS_A_SECOND: f64 = 1e9;

/// All that a page can show of a file.
#[derive(Default)]
pub(super) struct Messages {
    pub states: Vec<State>,
    /// Counters of the link with their times in s.
    pub link: Vec<(f64, LinkCounters)>,
    pub can: Vec<CanMessage>,
    /// Reports and commands of motors by topic, with their times in s.
    pub motors: BTreeMap<String, Vec<(f64, Fields)>>,
    pub topics: BTreeSet<String>,
    /// The file ends in the middle.
    pub is_cut_off: bool,
}

/// The values of a message by name.
pub(super) type Fields = BTreeMap<String, f64>;

/// A frame of a bus.
pub(super) struct CanMessage {
    pub t_s: f64,
    pub id: u16,
}

impl Messages {
    /// Reads a whole file. A file that is cut off is read as far as it goes.
    pub fn read(bytes: &[u8]) -> Result<Self, McapError> {
        let mut messages = Self::default();
        for message in MessageStream::new_with_options(bytes, Options::IgnoreEndMagic.into())? {
            match message {
                Ok(message) => {
                    let t_s = message.log_time as f64 / NS_A_SECOND;
                    messages.add(&message.channel.topic, t_s, &message.data);
                }
                Err(error) if messages.topics.is_empty() => return Err(error),
                Err(_) => {
                    messages.is_cut_off = true;
                    break;
                }
            }
        }
        Ok(messages)
    }

    /// Adds a message. One that is not as this tool writes it is left out.
    fn add(&mut self, topic: &str, t_s: f64, data: &[u8]) {
        if !self.topics.contains(topic) {
            self.topics.insert(topic.to_owned());
        }
        match topic {
            STATE_TOPIC => self.states.extend(serde_json::from_slice::<State>(data)),
            LINK_TOPIC => {
                let counters = serde_json::from_slice(data);
                self.link.extend(counters.map(|counters| (t_s, counters)));
            }
            "/can" => {
                #[derive(Deserialize)]
                struct Frame {
                    id: u16,
                }
                let frame = serde_json::from_slice::<Frame>(data);
                let message = frame.map(|Frame { id }| CanMessage { t_s, id });
                self.can.extend(message);
            }
            _ if topic.starts_with("/esc/") || topic.starts_with("/joint/") => {
                if let Ok(fields) = serde_json::from_slice(data) {
                    let of_motor = self.motors.entry(topic.to_owned()).or_default();
                    of_motor.push((t_s, fields));
                }
            }
            _ => {}
        }
    }
}
