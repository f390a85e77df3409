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
    /// Number of bytes held.
    len: usize,
    /// Place of the first byte that is not yet done with. It is 0 between calls.
    start: usize,
    /// Bit n is set if a frame has ended right before the byte n places after `start`.
    ends: u128,
    counters: ScanCounters,
}

impl<const N: usize> Scanner<N> {
    pub(super) fn new() -> Self {
        Self {
            held: [0; N],
            len: 0,
            start: 0,
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
            let Some(bytes) = self.rest().get(..len) else {
                break;
            };
            let frame = read(bytes);
            self.pass(len, frame, sink);
        }
        self.drop_what_is_done();
    }

    /// Gives up the frame that is not complete and looks for shorter ones in it.
    pub(super) fn flush<F: Frame>(&mut self, sink: &mut impl FnMut(Found<F>)) {
        while let Some(len) = self.due::<F>() {
            match self.rest().get(..len).map(read) {
                Some(frame) => self.pass(len, frame, sink),
                None => self.discard_one(),
            }
        }
        self.drop_what_is_done();
    }

    /// Bytes may be missing here: the next frame follows on none.
    pub(super) fn mark_gap(&mut self) {
        self.ends = 0;
    }

    fn rest(&self) -> &[u8] {
        self.held.get(self.start..self.len).unwrap_or_default()
    }

    /// Discards bytes that begin no frame. Returns the length of the frame whose header is then the first byte, `None`
    /// if no byte is left.
    fn due<F: Frame>(&mut self) -> Option<usize> {
        while let Some(header) = self.rest().first() {
            if let Some(len) = F::len(*header) {
                return Some(len);
            }
            self.discard_one();
        }
        None
    }

    /// Goes on behind a frame of `len` bytes, or behind its header alone if it is `None`.
    fn pass<F>(&mut self, len: usize, frame: Option<F>, sink: &mut impl FnMut(Found<F>)) {
        let contiguous = self.ends & 1 == 1;
        let Some(frame) = frame else {
            if contiguous {
                self.counters.crc_errors = self.counters.crc_errors.wrapping_add(1);
            }
            self.discard_one();
            return;
        };
        self.counters.good = self.counters.good.wrapping_add(1);
        self.ends |= 1_u128.wrapping_shl(len as u32);
        self.advance(if contiguous { len } else { 1 });
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
        self.start = self.start.wrapping_add(count);
        self.ends = self.ends.wrapping_shr(count as u32);
    }

    fn drop_what_is_done(&mut self) {
        if self.start == 0 {
            return;
        }
        if let Some(bytes) = self.held.get_mut(..self.len) {
            bytes.copy_within(self.start.min(bytes.len()).., 0);
        }
        self.len = self.len.saturating_sub(self.start);
        self.start = 0;
    }
}

/// A frame with a correct CRC and sensible content.
fn read<F: Frame>(bytes: &[u8]) -> Option<F> {
    if crc8(bytes) == 0 {
        F::read(bytes)
    } else {
        None
    }
}
