//! Reads the radio channels of a robot that cannot be armed.

use super::{Frame, HeldPosition};
use crate::tuning::{LiveReading, TuningClient, TuningError, live_page};
use robot_app::tuning::LiveValue;

/// Number of frames from a position that is held.
const READINGS: usize = 15;
/// Largest age of a frame. Then the robot itself takes its radio as lost.
const MOST_AGE_MS: f64 = 100.0;
/// DBUS has four sticks and a wheel.
const DBUS_CHANNELS: usize = 5;

#[derive(Debug, thiserror::Error)]
pub enum WatchError {
    #[error(transparent)]
    Tuning(#[from] TuningError),
    #[error("the robot is armed: switch enable off and begin again")]
    Armed,
    #[error("the robot left bring-up's read-only step, so it could be armed: begin again")]
    NotReadOnly,
    #[error("the robot hears no radio: switch the transmitter on, and look at `robotctl status`")]
    NotHeard,
    #[error(
        "only the first five channels send anything, as of DBUS, whose sticks and switches need no settings; with an SBUS \
         transmitter, give its switches channels first"
    )]
    Dbus,
}

pub struct Watch<'c> {
    client: &'c mut TuningClient,
}

impl<'c> Watch<'c> {
    /// Watches a robot whose bring-up is in its read-only step and stays there.
    pub fn new(client: &'c mut TuningClient) -> Self {
        Self { client }
    }

    /// Reads a position that the pilot holds.
    pub fn still(&mut self) -> Result<HeldPosition, WatchError> {
        let frames = (0..READINGS).map(|_| self.frame());
        let frames: Vec<Frame> = frames.collect::<Result<_, _>>()?;
        HeldPosition::of(&frames).ok_or(WatchError::NotHeard)
    }

    /// Reads all channels within about ten milliseconds.
    pub fn frame(&mut self) -> Result<Frame, WatchError> {
        self.check_disarmed()?;
        if self.page("bring-up", 0)?.choice("step") != "read-only" {
            return Err(WatchError::NotReadOnly);
        }
        let radio = self.page("radio", 0)?;
        let is_fresh = radio.number("age-ms").is_some_and(|ms| ms <= MOST_AGE_MS);
        if !is_fresh || radio.has("marks", "failsafe") {
            return Err(WatchError::NotHeard);
        }
        let mut frame = Frame::default();
        for (part, channels) in frame.chunks_mut(4).enumerate() {
            let reading = self.page("raw-channels", part)?;
            for (channel, (_, value)) in channels.iter_mut().zip(reading.values()) {
                if let LiveValue::Count(count) = value {
                    *channel = u16::try_from(count).unwrap_or(u16::MAX);
                }
            }
        }
        if frame[DBUS_CHANNELS..].iter().all(|count| *count == 0) {
            return Err(WatchError::Dbus);
        }
        Ok(frame)
    }

    pub fn check_disarmed(&mut self) -> Result<(), WatchError> {
        match self.page("arming", 0)?.choice("state").as_str() {
            "disarmed" => Ok(()),
            _ => Err(WatchError::Armed),
        }
    }

    fn page(&mut self, name: &'static str, part: usize) -> Result<LiveReading, WatchError> {
        let reading = self.client.live(live_page(name), part)?;
        Ok(reading.ok_or(TuningError::TooOld)?)
    }
}
