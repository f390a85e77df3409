//! The USB-to-serial adapter with which a PC is plugged into the 4-pin UART2.

use std::collections::VecDeque;

use crate::{
    time::{NS, Ps},
    wire::{LineFormat, Parity, UartChar},
};

/// The line format of the PC link (docs/pc-link.md).
pub const LINK_FORMAT: LineFormat = LineFormat {
    baud: 460_800,
    data_bits: 8,
    parity: Parity::None,
    stop_bits: 1,
};

/// Limit of bytes that wait for the line, 11 ms of it. Adapters that people own hold 256 to 576.
const OUTBOX: usize = 512;
/// Limit of bytes that wait for the PC. A full line reaches it in 90 ms.
const INBOX: usize = 4_096;

/// The adapter with its two queues. Both are bounded: a PC that is too slow for the line loses bytes.
#[derive(Clone, Debug, Default)]
pub struct SerialAdapter {
    plugged: bool,
    outbox: VecDeque<UartChar>,
    /// When the last character of the outbox leaves the line.
    line_free_at: Ps,
    inbox: VecDeque<(Ps, u8)>,
    sent: u64,
    lost: u64,
}

impl SerialAdapter {
    /// Whether it is plugged into the board and drives the line. It is not, at first.
    pub fn plugged(&self) -> bool {
        self.plugged
    }

    /// Plugs it in, or pulls it off. Whatever waits is dropped.
    pub fn set_plugged(&mut self, plugged: bool) {
        self.plugged = plugged;
        self.outbox.clear();
        self.inbox.clear();
    }

    /// Number of bytes that it accepts now.
    pub fn room(&self) -> usize {
        if self.plugged {
            OUTBOX - self.outbox.len()
        } else {
            0
        }
    }

    /// Queues bytes for the line, where they follow each other without a gap. Returns how many it accepted.
    pub fn send(&mut self, bytes: &[u8], now: Ps) -> usize {
        let accepted = bytes.len().min(self.room());
        for &byte in &bytes[..accepted] {
            let start = self.line_free_at.max(now + NS);
            self.line_free_at = start + LINK_FORMAT.char_time();
            self.outbox.push_back(UartChar {
                start,
                byte,
                format: LINK_FORMAT,
            });
        }
        accepted
    }

    /// The next byte received, with the end of its stop bit.
    pub fn take(&mut self) -> Option<(Ps, u8)> {
        self.inbox.pop_front()
    }

    /// Number of bytes sent to the board.
    pub fn sent(&self) -> u64 {
        self.sent
    }

    /// Number of bytes received that the PC did not take in time.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// When the next character starts; `Ps::MAX` if none waits.
    pub(crate) fn next_start(&self) -> Ps {
        self.outbox.front().map_or(Ps::MAX, |next| next.start)
    }

    /// The next character whose start bit begins at or before `now`.
    pub(crate) fn next_character(&mut self, now: Ps) -> Option<UartChar> {
        if self.next_start() > now {
            return None;
        }
        self.sent += 1;
        self.outbox.pop_front()
    }

    /// A character of the board ended at `now`. One in another format is lost.
    pub(crate) fn receive(&mut self, character: UartChar, now: Ps) {
        if !self.plugged || !LINK_FORMAT.understands(character.format) {
            return;
        }
        if self.inbox.len() < INBOX {
            self.inbox.push_back((now, character.byte));
        } else {
            self.lost += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::{MS, US};

    fn plugged() -> SerialAdapter {
        let mut adapter = SerialAdapter::default();
        adapter.set_plugged(true);
        adapter
    }

    fn of_board(byte: u8, baud: u32) -> UartChar {
        let format = LineFormat {
            baud,
            ..LINK_FORMAT
        };
        UartChar {
            start: 0,
            byte,
            format,
        }
    }

    /// Ten bits at 460,800 Bd are 21.7 µs.
    #[test]
    fn bytes_follow_each_other_at_the_rate_of_the_line() {
        let mut adapter = plugged();
        assert_eq!(adapter.send(&[1, 2, 3], MS), 3);
        assert_eq!(adapter.next_character(MS), None);
        let all = std::iter::from_fn(|| adapter.next_character(2 * MS));
        let starts: Vec<_> = all.map(|c| (c.start / NS, c.byte)).collect();
        let first = MS / NS + 1;
        assert_eq!(
            starts,
            [(first, 1), (first + 21_701, 2), (first + 43_402, 3)]
        );
    }

    #[test]
    fn an_adapter_that_is_not_plugged_in_neither_sends_nor_receives() {
        let mut adapter = SerialAdapter::default();
        assert_eq!((adapter.send(&[1], 0), adapter.room()), (0, 0));
        adapter.receive(of_board(7, 460_800), US);
        assert_eq!(adapter.take(), None);
    }

    #[test]
    fn a_flood_of_the_pc_waits_outside() {
        let mut adapter = plugged();
        assert_eq!(adapter.send(&[0; 1_000], 0), OUTBOX);
        assert_eq!(adapter.room(), 0);
    }

    #[test]
    fn a_pc_that_reads_nothing_loses_bytes_and_they_are_counted() {
        let mut adapter = plugged();
        for _ in 0..INBOX + 3 {
            adapter.receive(of_board(7, 461_538), US);
        }
        assert_eq!((adapter.lost(), adapter.take()), (3, Some((US, 7))));
    }

    #[test]
    fn a_wrong_rate_is_not_understood() {
        let mut adapter = plugged();
        adapter.receive(of_board(7, 500_000), US);
        assert_eq!(adapter.take(), None);
    }
}
