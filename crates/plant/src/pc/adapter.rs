//! The serial adapter through which a program outside of the simulation uses the link.

use std::collections::VecDeque;

/// Limit of bytes that wait for the line, a tenth of a second of it.
const OUTBOX: usize = 4_608;
/// Limit of bytes that wait for the program, a second of the line.
const INBOX: usize = 46_080;

/// The adapter with its two queues. Both are bounded: a program that is too slow for the line loses bytes.
#[derive(Debug, Default)]
pub struct SerialAdapter {
    open: bool,
    outbox: VecDeque<u8>,
    inbox: VecDeque<u8>,
    lost: u64,
}

impl SerialAdapter {
    /// Opens the adapter; until then it neither sends nor receives.
    pub fn open(&mut self) {
        self.open = true;
    }

    /// Queues bytes for the line and returns how many were taken.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        let room = if self.open {
            OUTBOX.saturating_sub(self.outbox.len())
        } else {
            0
        };
        let taken = bytes.len().min(room);
        self.outbox.extend(bytes.iter().take(taken));
        taken
    }

    /// Takes every byte that has been received, in order.
    pub fn take_all(&mut self) -> Vec<u8> {
        self.inbox.drain(..).collect()
    }

    /// Number of received bytes that were not taken in time.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    pub(super) fn is_empty(&self) -> bool {
        self.outbox.is_empty()
    }

    pub(super) fn next_to_send(&mut self) -> Option<u8> {
        self.outbox.pop_front()
    }

    pub(super) fn receive(&mut self, byte: u8) {
        if !self.open {
            return;
        }
        if self.inbox.len() < INBOX {
            self.inbox.push_back(byte);
        } else {
            self.lost += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_open_adapter_sends_and_receives() {
        let mut adapter = SerialAdapter::default();
        adapter.receive(1);
        assert_eq!((adapter.send(&[1, 2]), adapter.take_all()), (0, vec![]));
        adapter.open();
        adapter.receive(3);
        assert_eq!((adapter.send(&[1, 2]), adapter.take_all()), (2, vec![3]));
        assert_eq!(adapter.next_to_send(), Some(1));
    }

    #[test]
    fn both_queues_end() {
        let mut adapter = SerialAdapter::default();
        adapter.open();
        assert_eq!(adapter.send(&[0; 5_000]), OUTBOX);
        for _ in 0..INBOX + 3 {
            adapter.receive(0);
        }
        assert_eq!((adapter.lost(), adapter.take_all().len()), (3, INBOX));
    }
}
