//! The line to the board: characters one after another at 460800 8N1.

use std::collections::VecDeque;

use super::line_noise::LineNoise;
use crate::{
    time::{MS, Ps, SECOND},
    wire::{LineFormat, Parity, UartChar},
};

/// Format of both directions (docs/pc-link.md).
pub(super) const FORMAT: LineFormat = LineFormat {
    baud: 460_800,
    data_bits: 8,
    parity: Parity::None,
    stop_bits: 1,
};

/// A character that nobody has taken for this long is dropped, because a line has no memory.
const FORGOTTEN: Ps = 20 * MS;

/// Duration of one character without parity: start bit, data and stop bits.
pub(super) fn character_time(format: LineFormat) -> Ps {
    let bits = 1 + u64::from(format.data_bits) + u64::from(format.stop_bits);
    bits * SECOND / u64::from(format.baud)
}

/// Whether a receiver that is set to [`FORMAT`] reads a character of this format: 3 % of the rate are half of the last bit.
pub(super) fn readable(format: LineFormat) -> bool {
    let off_by = 100 * u64::from(format.baud.abs_diff(FORMAT.baud));
    off_by <= 3 * u64::from(FORMAT.baud)
        && format.data_bits == FORMAT.data_bits
        && format.parity == FORMAT.parity
}

#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    waiting: VecDeque<UartChar>,
    /// End and byte of the characters that have started.
    started: VecDeque<(Ps, u8)>,
    /// End of the last character.
    free: Ps,
}

impl Line {
    /// When a character that is sent at `now` can start.
    pub(super) fn free_from(&self, now: Ps) -> Ps {
        self.free.max(now)
    }

    /// Whether no character waits or is being sent.
    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty() && self.started.is_empty()
    }

    pub(super) fn send(&mut self, byte: u8, now: Ps) {
        self.send_through(byte, now, None);
    }

    /// Sends a character, which noise may change or swallow.
    pub(super) fn send_through(&mut self, byte: u8, now: Ps, noise: Option<&mut LineNoise>) {
        let sent = UartChar {
            start: self.free_from(now),
            byte,
            format: FORMAT,
        };
        self.free = sent.start + character_time(FORMAT);
        let arrives = match noise {
            Some(noise) => noise.disturb(sent),
            None => Some(sent),
        };
        self.waiting
            .retain(|character| character.start + FORGOTTEN > now);
        self.waiting.extend(arrives);
    }

    pub(super) fn drop_unstarted(&mut self, now: Ps) {
        self.waiting.retain(|character| character.start <= now);
        self.free = now.min(self.free);
    }

    pub(super) fn next_start(&self, now: Ps) -> Ps {
        let starts = self.waiting.iter().map(|character| character.start);
        starts
            .into_iter()
            .find(|start| *start > now)
            .unwrap_or(Ps::MAX)
    }

    pub(super) fn take(&mut self, now: Ps) -> Option<UartChar> {
        self.waiting
            .pop_front_if(|next| next.start <= now)
            .inspect(|c| {
                self.started
                    .push_back((c.start + character_time(c.format), c.byte));
            })
    }

    /// The next character whose stop bit has ended by `now`, with the time of that.
    pub(super) fn next_ended(&mut self, now: Ps) -> Option<(Ps, u8)> {
        self.started.pop_front_if(|(end, _)| *end <= now)
    }
}
