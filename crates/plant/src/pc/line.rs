//! The line to the board, with what is on it and what is still to come.

use std::collections::VecDeque;

use crate::{
    serial_adapter::LINK_FORMAT,
    time::{MS, Ps},
    wire::{LineEvent, UartChar},
};

/// What nobody has taken for this long is dropped, because a line has no memory.
const FORGOTTEN: Ps = 20 * MS;

#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    waiting: VecDeque<LineEvent>,
    /// End and byte of the characters that have started.
    started: VecDeque<(Ps, u8)>,
    /// End of the program's last character.
    free: Ps,
}

impl Line {
    /// When a character that is sent at `now` can start.
    pub(super) fn free_from(&self, now: Ps) -> Ps {
        self.free.max(now)
    }

    /// A character that follows the one before without a gap.
    pub(super) fn next_character(&mut self, byte: u8, now: Ps) -> UartChar {
        let start = self.free_from(now);
        self.free = start + LINK_FORMAT.char_time();
        UartChar {
            start,
            byte,
            format: LINK_FORMAT,
        }
    }

    pub(super) fn put(&mut self, event: LineEvent) {
        let start = event.start();
        self.waiting.retain(|old| old.start() + FORGOTTEN > start);
        self.waiting.push_back(event);
    }

    pub(super) fn hold_low(&mut self, from: Ps, until: Ps) {
        self.put(LineEvent::Low { from, until });
    }

    pub(super) fn drop_unstarted(&mut self, now: Ps) {
        self.waiting.retain(|event| event.start() <= now);
        self.free = self.free.min(now);
    }

    pub(super) fn next_start(&self, now: Ps) -> Ps {
        let starts = self.waiting.iter().map(LineEvent::start);
        starts
            .into_iter()
            .find(|start| *start > now)
            .unwrap_or(Ps::MAX)
    }

    pub(super) fn take(&mut self, now: Ps) -> Option<LineEvent> {
        let event = self.waiting.pop_front_if(|next| next.start() <= now)?;
        if let LineEvent::Character(c) = event {
            let end = c.start + c.format.char_time();
            self.started.push_back((end, c.byte));
        }
        Some(event)
    }

    /// The next character whose stop bit has ended by `now`, with the time of that.
    pub(super) fn next_ended(&mut self, now: Ps) -> Option<(Ps, u8)> {
        self.started.pop_front_if(|(end, _)| *end <= now)
    }
}
