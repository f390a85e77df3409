//! Replies on the tuning channel that a PC's adapter receives on either bus.

use crate::wire::CanFrame;

/// Identifier of a reply (docs/tuning.md).
const REPLY_ID: u32 = 0x7A2;

#[derive(Clone, Copy, Debug)]
pub(super) struct TuningReplies {
    pub(super) count: u64,
    /// Bytes of the last one, NaN beyond its end.
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

impl TuningReplies {
    /// Takes a frame from the bus; true if it is a reply.
    pub(super) fn record(&mut self, frame: &CanFrame) -> bool {
        if frame.id != REPLY_ID || frame.extended || frame.remote {
            return false;
        }
        self.last = [f64::NAN; 8];
        let bytes = frame.data.iter().take(frame.dlc.into());
        for (value, byte) in self.last.iter_mut().zip(bytes) {
            *value = f64::from(*byte);
        }
        self.count += 1;
        true
    }
}
