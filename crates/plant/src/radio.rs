//! The receiver on the DBUS connector and the pilot behind it.

mod dbus;
mod faults;
mod line_noise;
mod pilot;
mod sbus;

use std::collections::VecDeque;

use crate::{
    random::{Random, Stream},
    time::Ps,
    wire::UartChar,
};
pub(crate) use faults::RadioFaults;
use line_noise::LineNoise;
use pilot::Pilot;
pub use pilot::RemoteInput;

/// The receiver on the DBUS connector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RadioKind {
    /// SBUS, 16 channels every 7 ms.
    #[default]
    Sbus,
    /// DJI DR16, 18 bytes every 14 ms.
    Dbus,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Loss {
    Flagged,
    Missing,
}

/// Sends one frame per period from power-on, with the sticks as they are at the first bit of the frame.
#[derive(Clone)]
pub(crate) struct Receiver {
    kind: RadioKind,
    pilot: Pilot,
    /// Sticks and switches in the last packet received.
    received: Pilot,
    /// Frames since the stand switch moved.
    since_stand: u32,
    next_frame: Ps,
    on_the_line: VecDeque<UartChar>,
    noise: LineNoise,
    losses: Random,
}

impl Receiver {
    pub(crate) fn new(kind: RadioKind, seed: u64) -> Self {
        Self {
            kind,
            pilot: Pilot::default(),
            received: Pilot::default(),
            since_stand: 0,
            next_frame: 0,
            on_the_line: VecDeque::new(),
            noise: LineNoise::new(Random::new(seed, Stream::RadioLine)),
            losses: Random::new(seed, Stream::RadioLosses),
        }
    }

    pub(crate) fn pilot(&self) -> &Pilot {
        &self.pilot
    }

    pub(crate) fn set_remote(&mut self, input: RemoteInput) {
        self.pilot.apply(input);
    }

    pub(crate) fn next_frame(&self) -> Ps {
        self.next_frame
    }

    /// Start of the first character after `now`, or else of the next frame.
    pub(crate) fn next_event(&self, now: Ps) -> Ps {
        self.on_the_line
            .iter()
            .map(|character| character.start)
            .find(|&start| start > now)
            .unwrap_or(Ps::MAX)
            .min(self.next_frame)
    }

    /// Puts the frame that is due at `next_frame` on the line.
    pub(crate) fn start_frame(&mut self, faults: RadioFaults) {
        let start = self.next_frame;
        let lost = self.lose(faults);
        let frame = self.frame(RadioFaults {
            frame_lost: faults.frame_lost || lost.is_some(),
            ..faults
        });
        let (format, period) = match self.kind {
            RadioKind::Sbus => (sbus::FORMAT, sbus::PERIOD),
            RadioKind::Dbus => (dbus::FORMAT, dbus::PERIOD),
        };
        self.next_frame = start + period;
        if faults.silent || lost == Some(Loss::Missing) {
            return;
        }
        // A character that was not taken within two periods is dropped, because a line has no memory.
        self.on_the_line
            .retain(|character| character.start + 2 * period > start);
        let character_time = format.char_time();
        let mut characters: Vec<UartChar> = frame
            .into_iter()
            .flatten()
            .enumerate()
            .map(|(index, byte)| UartChar {
                start: start + index as Ps * character_time,
                byte,
                format,
            })
            .collect();
        if faults.noise {
            self.noise
                .disturb(&mut characters, start, period, character_time, format);
        }
        self.on_the_line.extend(characters);
    }

    /// Decides whether this frame is lost. The receiver flags half of the lost frames and does not send the other half.
    fn lose(&mut self, faults: RadioFaults) -> Option<Loss> {
        if faults.loss == 0.0 || self.losses.unit() >= faults.loss {
            None
        } else if self.losses.unit() < 0.5 {
            Some(Loss::Flagged)
        } else {
            Some(Loss::Missing)
        }
    }

    /// The bytes of the frame. A receiver without a new packet repeats the sticks of the last one.
    fn frame(&mut self, faults: RadioFaults) -> Option<Vec<u8>> {
        if !(faults.failsafe || faults.frame_lost) {
            self.since_stand = if self.pilot.stand == self.received.stand {
                self.since_stand.saturating_add(1)
            } else {
                0
            };
            self.received = self.pilot;
        }
        match self.kind {
            RadioKind::Sbus => Some(sbus::frame(&self.received, faults).to_vec()),
            RadioKind::Dbus => {
                let wheel = dbus::wheel(&self.received, self.since_stand);
                dbus::frame(&self.received, wheel, faults).map(|frame| frame.to_vec())
            }
        }
    }

    /// Drops every character that has not started yet.
    pub(crate) fn unplug(&mut self, now: Ps) {
        self.on_the_line.retain(|character| character.start <= now);
    }

    pub(crate) fn take(&mut self, now: Ps) -> Option<UartChar> {
        if self.on_the_line.front()?.start > now {
            return None;
        }
        self.on_the_line.pop_front()
    }
}
