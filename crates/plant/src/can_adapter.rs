//! The CAN adapter of a PC, whose frames come from outside of the simulation.

use std::collections::VecDeque;

use crate::{time::Ps, wire::CanFrame};

/// Limit of frames that wait for the bus. More would take 30 ms or longer to send.
const OUTBOX: usize = 256;
/// Limit of frames that wait for the PC. A bus at full load reaches it in a tenth of a second.
const INBOX: usize = 1_024;

/// How the adapter takes part in its bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AdapterMode {
    /// Not on the bus.
    #[default]
    Off,
    /// Receives what others acknowledge.
    ListenOnly,
    /// Sends, receives and acknowledges.
    Active,
}

/// The adapter with its two queues. Both are bounded: a PC that is too slow for the bus loses frames.
#[derive(Clone, Debug, Default)]
pub struct CanAdapter {
    mode: AdapterMode,
    outbox: VecDeque<CanFrame>,
    inbox: VecDeque<(Ps, CanFrame)>,
    sent: u64,
    lost: u64,
}

impl CanAdapter {
    /// How it takes part in its bus.
    pub fn mode(&self) -> AdapterMode {
        self.mode
    }

    /// Changes the mode and drops all frames that wait.
    pub fn set_mode(&mut self, mode: AdapterMode) {
        self.mode = mode;
        self.outbox.clear();
        self.inbox.clear();
    }

    /// Queues a frame for the bus. False if it cannot be sent: the adapter is not active, or too many frames wait.
    pub fn send(&mut self, frame: CanFrame) -> bool {
        let taken = self.mode == AdapterMode::Active && self.outbox.len() < OUTBOX;
        if taken {
            self.outbox.push_back(frame);
        }
        taken
    }

    /// The next frame received, with the end of its transmission.
    pub fn take(&mut self) -> Option<(Ps, CanFrame)> {
        self.inbox.pop_front()
    }

    /// Number of frames sent and acknowledged.
    pub fn sent(&self) -> u64 {
        self.sent
    }

    /// Number of received frames that were not taken in time.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    pub(crate) fn pending(&self) -> Option<CanFrame> {
        self.outbox.front().copied()
    }

    pub(crate) fn delivered(&mut self) {
        self.outbox.pop_front();
        self.sent += 1;
    }

    pub(crate) fn receive(&mut self, frame: &CanFrame, now: Ps) {
        if self.inbox.len() < INBOX {
            self.inbox.push_back((now, *frame));
        } else {
            self.lost += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u32) -> CanFrame {
        CanFrame {
            id,
            extended: false,
            remote: false,
            dlc: 0,
            data: [0; 8],
        }
    }

    #[test]
    fn only_an_active_adapter_takes_frames_to_send() {
        let mut adapter = CanAdapter::default();
        assert!(!adapter.send(frame(1)));
        adapter.set_mode(AdapterMode::ListenOnly);
        assert!(!adapter.send(frame(1)));
        adapter.set_mode(AdapterMode::Active);
        assert!(adapter.send(frame(1)));
        assert_eq!(adapter.pending(), Some(frame(1)));
        adapter.delivered();
        assert_eq!((adapter.pending(), adapter.sent()), (None, 1));
    }

    #[test]
    fn a_pc_that_reads_nothing_loses_frames_and_they_are_counted() {
        let mut adapter = CanAdapter::default();
        adapter.set_mode(AdapterMode::ListenOnly);
        for id in 0..INBOX as u32 + 3 {
            adapter.receive(&frame(id), 7);
        }
        assert_eq!(adapter.lost(), 3);
        assert_eq!(adapter.take(), Some((7, frame(0))));
    }

    #[test]
    fn a_frame_too_many_is_refused() {
        let mut adapter = CanAdapter::default();
        adapter.set_mode(AdapterMode::Active);
        let taken = (0..300).filter(|id| adapter.send(frame(*id))).count();
        assert_eq!(taken, OUTBOX);
    }
}
