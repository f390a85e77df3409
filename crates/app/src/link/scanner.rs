//! Finds frames in a stream of bytes that may be damaged anywhere.
//!
//! The scanner waits at a header for the length that belongs to it and then checks the frame. If that fails, it drops
//! only one byte and looks again at what it holds, so damage never hides the frame after it.
//!
//! One of 256 false headers has a matching CRC by chance. So a frame that does not follow directly on another one is
//! reported as not contiguous, and its bytes are searched for further frames: it hides none either.

use super::crc8;

/// What a scanner has counted. The counters wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScanCounters {
    /// Frames with a correct CRC.
    pub good: u32,
    /// Frames that began where one was due, but had a wrong CRC or content that no frame has.
    pub crc_errors: u32,
    /// Times that bytes were discarded to find the next frame.
    pub resyncs: u32,
    /// Bytes that belonged to no frame.
    pub discarded_bytes: u32,
}

/// A kind of frame on the line.
pub(super) trait Frame: Sized {
    /// Length of the frames that begin with `header`, `None` if none does. At most the scanner's `N`.
    fn len(header: u8) -> Option<usize>;
    /// Reads a frame of that length. The CRC is correct.
    fn read(bytes: &[u8]) -> Option<Self>;
}

/// A frame that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found<F> {
    pub(super) frame: F,
    /// The frame begins where another one, or nothing at all, had ended.
    pub(super) contiguous: bool,
}

/// A scanner for frames of at most `N` bytes, `N` below 128.
///
/// Each byte costs at most one CRC over `N` bytes: that is so on a line full of headers.
#[derive(Clone, Debug)]
pub(super) struct Scanner<const N: usize> {
    held: [u8; N],
    len: usize,
    /// Bit n is set if a frame has ended right before the byte at place n.
    ends: u128,
    counters: ScanCounters,
}

impl<const N: usize> Scanner<N> {
    pub(super) fn new() -> Self {
        Self {
            held: [0; N],
            len: 0,
            ends: 1,
            counters: ScanCounters::default(),
        }
    }

    pub(super) fn counters(&self) -> ScanCounters {
        self.counters
    }

    /// Number of bytes of a frame that is not complete.
    pub(super) fn held(&self) -> usize {
        self.len
    }

    /// Takes one byte. A frame of the greatest length is found with its last byte, so at most one such is found.
    pub(super) fn push<F: Frame>(&mut self, byte: u8, sink: &mut impl FnMut(Found<F>)) {
        if let Some(place) = self.held.get_mut(self.len) {
            *place = byte;
            self.len = self.len.wrapping_add(1);
        }
        while let Some(len) = self.due::<F>() {
            if self.len < len {
                return;
            }
            self.check(len, sink);
        }
    }

    /// Gives up the frame that is not complete and looks for shorter ones in it.
    pub(super) fn flush<F: Frame>(&mut self, sink: &mut impl FnMut(Found<F>)) {
        while let Some(len) = self.due::<F>() {
            if self.len < len {
                self.discard_one();
            } else {
                self.check(len, sink);
            }
        }
    }

    /// Bytes may be missing here: the next frame follows on none.
    pub(super) fn mark_gap(&mut self) {
        self.ends = 0;
    }

    /// Drops bytes that begin no frame. Returns the length of the frame whose header is then the first byte held,
    /// `None` if no byte is left.
    fn due<F: Frame>(&mut self) -> Option<usize> {
        while let Some(header) = self.held.first().filter(|_| self.len > 0) {
            if let Some(len) = F::len(*header) {
                return Some(len);
            }
            self.discard_one();
        }
        None
    }

    /// Checks the frame of `len` bytes at the start of the buffer.
    fn check<F: Frame>(&mut self, len: usize, sink: &mut impl FnMut(Found<F>)) {
        let contiguous = self.ends & 1 == 1;
        let bytes = self.held.get(..len).unwrap_or_default();
        let frame = if crc8(bytes) == 0 {
            F::read(bytes)
        } else {
            None
        };
        let Some(frame) = frame else {
            if contiguous {
                self.counters.crc_errors = self.counters.crc_errors.wrapping_add(1);
            }
            self.discard_one();
            return;
        };
        self.counters.good = self.counters.good.wrapping_add(1);
        self.ends |= 1_u128.wrapping_shl(len as u32);
        if contiguous {
            self.advance(len);
        } else {
            self.advance(1);
        }
        sink(Found { frame, contiguous });
    }

    fn discard_one(&mut self) {
        if self.ends & 1 == 1 {
            self.counters.resyncs = self.counters.resyncs.wrapping_add(1);
        }
        // A later end means that a frame covers this byte.
        if self.ends <= 1 {
            self.counters.discarded_bytes = self.counters.discarded_bytes.wrapping_add(1);
        }
        self.advance(1);
    }

    fn advance(&mut self, count: usize) {
        self.held.copy_within(count.min(N).., 0);
        self.len = self.len.saturating_sub(count);
        self.ends = self.ends.wrapping_shr(count as u32);
    }
}
