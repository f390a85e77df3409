//! Writes and reads the fields of a frame one after the other.

use super::crc8;

/// Builds a frame of `N` bytes.
pub(super) struct FrameWriter<const N: usize> {
    frame: [u8; N],
    at: usize,
}

impl<const N: usize> FrameWriter<N> {
    pub(super) fn new(header: u8) -> Self {
        let mut writer = Self {
            frame: [0; N],
            at: 0,
        };
        writer.put([header]);
        writer
    }

    pub(super) fn put<const M: usize>(&mut self, field: [u8; M]) {
        let end = self.at.wrapping_add(M);
        if let Some(place) = self.frame.get_mut(self.at..end) {
            place.copy_from_slice(&field);
        }
        self.at = end;
    }

    /// Puts the CRC in the last byte.
    pub(super) fn finish(mut self) -> [u8; N] {
        if let Some((last, before)) = self.frame.split_last_mut() {
            *last = crc8(before);
        }
        self.frame
    }
}

/// Reads the payload of a frame.
pub(super) struct FrameReader<'a> {
    rest: &'a [u8],
}

impl<'a> FrameReader<'a> {
    /// Returns `None` if header or CRC is wrong.
    pub(super) fn new(header: u8, frame: &'a [u8]) -> Option<Self> {
        let rest = frame.strip_prefix(&[header])?;
        (crc8(frame) == 0).then_some(Self { rest })
    }

    /// The next field, zeros past the end.
    pub(super) fn take<const M: usize>(&mut self) -> [u8; M] {
        let Some((field, rest)) = self.rest.split_first_chunk() else {
            return [0; M];
        };
        self.rest = rest;
        *field
    }

    pub(super) fn take_f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }

    pub(super) fn take_f32s<const M: usize>(&mut self) -> [f32; M] {
        core::array::from_fn(|_| self.take_f32())
    }
}
