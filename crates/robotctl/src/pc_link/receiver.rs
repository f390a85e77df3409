//! Counts damage from the first good frame on.

use robot_app::link::{Heard, PcReceiver, ScanCounters};

/// A receiver that may begin in the middle of a frame.
#[derive(Debug, Default)]
pub(super) struct Receiver {
    receiver: PcReceiver,
    /// What was counted with the first good frame; `None` before it.
    first: Option<ScanCounters>,
}

impl Receiver {
    pub fn feed(&mut self, bytes: &[u8], mut sink: impl FnMut(Heard)) {
        let mut rest = bytes;
        // Byte by byte, as only the counters say where the first good frame ends.
        while self.first.is_none()
            && let Some((byte, following)) = rest.split_first()
        {
            self.receiver.feed(&[*byte], &mut sink);
            let counters = self.receiver.counters();
            self.first = (counters.good > 0).then_some(counters);
            rest = following;
        }
        self.receiver.feed(rest, sink);
    }

    /// All zeros before the first good frame.
    pub fn counters(&self) -> ScanCounters {
        let now = self.receiver.counters();
        let Some(first) = self.first else {
            return ScanCounters::default();
        };
        ScanCounters {
            good: now.good,
            crc_errors: now.crc_errors.wrapping_sub(first.crc_errors),
            resyncs: now.resyncs.wrapping_sub(first.resyncs),
            discarded_bytes: now.discarded_bytes.wrapping_sub(first.discarded_bytes),
        }
    }
}

#[cfg(test)]
mod tests {
    use robot_app::link::{Uplink, crc8};

    use super::*;

    fn fed(pieces: &[&[u8]]) -> (ScanCounters, u32) {
        let mut receiver = Receiver::default();
        let mut heard = 0;
        for piece in pieces {
            receiver.feed(piece, |_| heard += 1);
        }
        (receiver.counters(), heard)
    }

    #[test]
    fn only_damage_after_the_first_good_frame_counts() {
        let mut frame = Uplink::default().encode();
        let end = frame.len() - 1;
        // A header in the middle, as any content may have.
        frame[10] = 0xFE;
        frame[end] = crc8(&frame[..end]);
        let whole = frame.as_slice();
        let part = &whole[10..];
        let (counters, heard) = fed(&[part, whole, whole]);
        assert_eq!((counters.good, heard), (2, 2));
        assert_eq!((counters.crc_errors, counters.discarded_bytes), (0, 0));
        let (counters, heard) = fed(&[part, whole, b"xyz", whole]);
        assert_eq!((counters.good, heard), (2, 2));
        assert_eq!((counters.resyncs, counters.discarded_bytes), (1, 3));
        let mut damaged = frame;
        damaged[20] ^= 1;
        let (counters, _) = fed(&[part, whole, &damaged, whole]);
        assert_eq!((counters.good, counters.crc_errors), (2, 1));
    }
}
