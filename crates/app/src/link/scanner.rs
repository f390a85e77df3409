//! Finds frames in a stream of bytes that may be damaged anywhere.
//!
//! The scanner waits at a header for the length that belongs to it and then checks the frame. If that fails, it goes on
//! by only one byte, so damage never hides the frame after it.
//!
//! One of 256 false headers has a matching CRC by chance. So a frame that does not follow directly on another one is
//! reported as not contiguous, and its bytes are searched for further frames: it hides none either.
//!
//! Each byte is taken into the CRC once, and looked at once as a header, whatever the line carries.

use super::crc8;

/// Places in the ring, a power of two above the length of the longest frame.
const PLACES: u8 = 128;

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

/// Length of a kind of frame, and what its CRC needs.
#[derive(Debug)]
pub(super) struct Shape {
    len: u8,
    /// The CRC's state after `len` bytes of zero, by its state before.
    after_zeros: [u8; 256],
}

impl Shape {
    /// `len` is below [`PLACES`].
    pub(super) const fn new(len: usize) -> Self {
        assert!(len < PLACES as usize);
        Self {
            len: len as u8,
            after_zeros: crc8::after_zeros(len),
        }
    }

    /// Whether the CRC over `len` bytes is right, from its running state before and after them. The CRC is linear: a
    /// frame, over which it is 0 from a start of 0, changes any other state as zeros do.
    fn is_right(&self, before: u8, after: u8) -> bool {
        self.after_zeros.get(usize::from(before)) == Some(&after)
    }
}

/// A kind of frame on the line.
pub(super) trait Frame: Sized {
    /// Shape of the frames that begin with `header`, `None` if none does.
    fn shape(header: u8) -> Option<&'static Shape>;
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

/// A scanner for frames of any number of kinds.
///
/// The byte with number n in the stream is in place n modulo [`PLACES`], and numbers are kept modulo 256.
#[derive(Clone, Debug)]
pub(super) struct Scanner {
    bytes: Ring<u8>,
    /// State of the running CRC before each byte.
    crcs: Ring<u8>,
    /// A frame has ended right before the byte.
    follows_frame: Ring<bool>,
    /// Number of the first byte that is not done with.
    first: u8,
    /// Number of the next byte.
    next: u8,
    /// There is nothing to decide before so many bytes are held.
    wanted: u8,
    /// Bytes from `first` on that belong to a frame already found.
    covered: u8,
    counters: ScanCounters,
}

#[derive(Clone, Debug)]
struct Ring<T>([T; PLACES as usize]);

impl<T: Copy + Default> Ring<T> {
    fn new() -> Self {
        Self([T::default(); PLACES as usize])
    }

    fn get(&self, number: u8) -> T {
        let place = self.0.get(usize::from(number % PLACES));
        place.copied().unwrap_or_default()
    }

    fn set(&mut self, number: u8, value: T) {
        if let Some(place) = self.0.get_mut(usize::from(number % PLACES)) {
            *place = value;
        }
    }
}

impl Scanner {
    pub(super) fn new() -> Self {
        let mut follows_frame = Ring::new();
        follows_frame.set(0, true);
        Self {
            bytes: Ring::new(),
            crcs: Ring::new(),
            follows_frame,
            first: 0,
            next: 0,
            wanted: 0,
            covered: 0,
            counters: ScanCounters::default(),
        }
    }

    pub(super) fn counters(&self) -> ScanCounters {
        self.counters
    }

    /// Number of bytes that are not done with.
    pub(super) fn held(&self) -> u8 {
        self.next.wrapping_sub(self.first)
    }

    /// Takes bytes. `sink` gets each frame, and the number of bytes among them that came after its last one; that is
    /// exact for the longest kind of frame, which is found with its last byte.
    pub(super) fn feed<F: Frame>(&mut self, bytes: &[u8], sink: &mut impl FnMut(Found<F>, usize)) {
        let mut rest = bytes;
        while let Some((byte, following)) = rest.split_first() {
            rest = following;
            if self.held() == 0 && F::shape(*byte).is_none() {
                self.discard_one();
                self.next = self.first;
                continue;
            }
            self.append(*byte);
            if self.held() >= self.wanted {
                self.decide(&mut |found| sink(found, following.len()));
            }
        }
    }

    /// Gives up the frame that is not complete and looks for shorter ones in it.
    pub(super) fn flush<F: Frame>(&mut self, sink: &mut dyn FnMut(Found<F>)) {
        while self.held() > 0 {
            self.discard_one();
            self.decide(sink);
        }
    }

    /// Bytes may be missing here: the next frame follows on none.
    pub(super) fn mark_gap(&mut self) {
        self.follows_frame = Ring::new();
    }

    fn append(&mut self, byte: u8) {
        let crc = crc8::next(self.crcs.get(self.next), byte);
        self.bytes.set(self.next, byte);
        self.next = self.next.wrapping_add(1);
        self.crcs.set(self.next, crc);
    }

    /// Goes on until a frame is not complete or no byte is left. Like `accept` it exists once for each kind of frames,
    /// as flash is scarce.
    fn decide<F: Frame>(&mut self, sink: &mut dyn FnMut(Found<F>)) {
        self.wanted = 0;
        while self.held() > 0 {
            let Some(shape) = F::shape(self.bytes.get(self.first)) else {
                self.discard_one();
                continue;
            };
            if self.held() < shape.len {
                self.wanted = shape.len;
                return;
            }
            let end = self.first.wrapping_add(shape.len);
            let is_right = shape.is_right(self.crcs.get(self.first), self.crcs.get(end));
            if !is_right || !self.accept(shape.len, sink) {
                let due = self.follows_frame.get(self.first);
                self.counters.crc_errors = self.counters.crc_errors.wrapping_add(due.into());
                self.discard_one();
            }
        }
    }

    /// Goes on behind the frame of `len` bytes at the first byte, or behind its header alone if it is not contiguous.
    /// Returns whether its content makes sense. It is out of line, as it is rarely reached on a line full of headers.
    #[inline(never)]
    fn accept<F: Frame>(&mut self, len: u8, sink: &mut dyn FnMut(Found<F>)) -> bool {
        let Some(frame) = self.read(len) else {
            return false;
        };
        let contiguous = self.follows_frame.get(self.first);
        let end = self.first.wrapping_add(len);
        self.counters.good = self.counters.good.wrapping_add(1);
        self.covered = self.covered.max(len);
        for _ in 0..if contiguous { len } else { 1 } {
            self.advance();
        }
        self.follows_frame.set(end, true);
        sink(Found { frame, contiguous });
        true
    }

    /// Reads the first `len` bytes.
    fn read<F: Frame>(&self, len: u8) -> Option<F> {
        let mut bytes = [0; PLACES as usize];
        for (byte, offset) in bytes.iter_mut().zip(0..len) {
            *byte = self.bytes.get(self.first.wrapping_add(offset));
        }
        F::read(bytes.get(..usize::from(len))?)
    }

    fn discard_one(&mut self) {
        if self.follows_frame.get(self.first) {
            self.counters.resyncs = self.counters.resyncs.wrapping_add(1);
        }
        if self.covered == 0 {
            self.counters.discarded_bytes = self.counters.discarded_bytes.wrapping_add(1);
        }
        self.advance();
    }

    fn advance(&mut self) {
        self.follows_frame.set(self.first, false);
        self.first = self.first.wrapping_add(1);
        self.covered = self.covered.saturating_sub(1);
    }
}
