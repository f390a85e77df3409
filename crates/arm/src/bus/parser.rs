//! Finds frames in a stream of bytes with damage in it.

use super::frame::{Frame, HEADER, checksum, longest};

/// What was found.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Found {
    Frame(Frame),
    /// A frame whose checksum is wrong. The search goes on with its second byte.
    Damaged,
}

/// Takes bytes one after the other. It keeps no more than the longest frame.
#[derive(Debug)]
pub(super) struct Parser {
    /// Begins with what may be a frame.
    bytes: Vec<u8>,
    longest: usize,
    skipped: u64,
}

impl Default for Parser {
    fn default() -> Self {
        Self {
            bytes: Vec::with_capacity(longest()),
            longest: longest(),
            skipped: 0,
        }
    }
}

impl Parser {
    /// Empties the parser. A frame of more than `longest` bytes is not waited for: a damaged length would swallow the answers
    /// behind it.
    pub(super) fn restart(&mut self, longest: usize) {
        self.skipped += self.bytes.len() as u64;
        self.bytes.clear();
        self.longest = longest;
    }

    pub(super) fn push(&mut self, byte: u8) {
        self.bytes.push(byte);
    }

    /// Returns what the bytes so far have. To be called after every byte until it returns `None`.
    ///
    /// The search goes on behind a frame that is wanted, and within one that is not: a length that is damaged to two more makes
    /// a whole frame of an answer and the header behind it, with a right checksum.
    pub(super) fn next(&mut self, is_wanted: impl Fn(&Frame) -> bool) -> Option<Found> {
        loop {
            match *self.bytes.as_slice() {
                [] | [0xFF] | [0xFF, 0xFF] => return None,
                // No servo has the id 0xFF, so its two bytes before are none of a header.
                [0xFF, 0xFF, 0xFF, ..] => self.skip(),
                [0xFF, 0xFF, _] => return None,
                [0xFF, 0xFF, _, length, ..] => {
                    let size = HEADER + usize::from(length);
                    if length < 2 || size > self.longest {
                        self.skip();
                        continue;
                    }
                    let whole = self.bytes.get(..size)?;
                    let frame = Frame::new(whole);
                    return Some(self.judge(frame, is_wanted));
                }
                _ => self.skip(),
            }
        }
    }

    /// Gives up the frame that is not complete: what comes after its first byte may have another.
    pub(super) fn give_up(&mut self) -> bool {
        let has_more = !self.bytes.is_empty();
        if has_more {
            self.skip();
        }
        has_more
    }

    /// Number of bytes so far that were part of no frame.
    pub(super) fn skipped(&self) -> u64 {
        self.skipped
    }

    fn judge(&mut self, frame: Frame, is_wanted: impl Fn(&Frame) -> bool) -> Found {
        let bytes = frame.bytes();
        let (body, sum) = bytes.split_at(bytes.len() - 1);
        let is_right = sum == [checksum(&body[2..])];
        if is_right && is_wanted(&frame) {
            self.bytes.drain(..bytes.len());
        } else {
            self.skip();
        }
        if is_right {
            Found::Frame(frame)
        } else {
            Found::Damaged
        }
    }

    fn skip(&mut self) {
        self.bytes.remove(0);
        self.skipped += 1;
    }
}

#[cfg(test)]
mod tests;
