//! Replies on the tuning channel, as a PC's adapter hears them on either bus.

use super::{WireEvent, World, signals};
use crate::{time::Ps, wire::CanFrame};

const REPLY_ID: u32 = 0x7A2;

#[derive(Clone, Copy, Debug)]
pub(super) struct TuningReplies {
    pub(super) count: u64,
    /// Bytes of the last one, not a number where it had none.
    pub(super) last: [f64; 8],
}

impl Default for TuningReplies {
    fn default() -> Self {
        Self {
            count: 0,
            last: [f64::NAN; 8],
        }
    }
}

impl World {
    pub(super) fn note_tuning_reply(&mut self, frame: &CanFrame, at: Ps) {
        if frame.id != REPLY_ID || frame.extended || frame.remote {
            return;
        }
        let bytes = frame.data.iter().take(frame.dlc.into());
        let mut last = [f64::NAN; 8];
        for (value, byte) in last.iter_mut().zip(bytes) {
            *value = f64::from(*byte);
        }
        self.tuning_replies.last = last;
        self.tuning_replies.count += 1;
        let count = (signals::TUNING_REPLIES, self.tuning_replies.count as f64);
        let bytes = last.iter().enumerate();
        let bytes = bytes.map(|(index, value)| (signals::tuning_reply(index), *value));
        let events = [count].into_iter().chain(bytes);
        self.wire_events
            .extend(events.map(|(signal, value)| WireEvent { at, signal, value }));
    }
}
