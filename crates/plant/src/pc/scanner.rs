//! Finds frames in a stream of bytes that may be damaged.

use super::codec::{self, DRIVE_HEADER, DRIVE_LEN, HEADER};

/// Header and length of a frame of the tuning channel. It is passed over, and so is one that drives.
const TUNNEL_HEADER: u8 = 0xFD;
const TUNNEL_LEN: usize = 12;

/// Finds frames of `LEN` bytes by header and checksum. After a wrong checksum it drops one byte and looks again.
#[derive(Clone, Debug, Default)]
pub struct Scanner<const LEN: usize> {
    waiting: Vec<u8>,
    /// Frames with a wrong checksum.
    pub(super) crc_errors: u64,
    /// Bytes that belonged to no frame.
    pub(super) discarded: u64,
}

impl<const LEN: usize> Scanner<LEN> {
    /// Takes one byte, and returns the frame that it completes.
    pub fn take(&mut self, byte: u8) -> Option<[u8; LEN]> {
        self.waiting.push(byte);
        while let Some(header) = self.waiting.first() {
            let length = match *header {
                HEADER => LEN,
                TUNNEL_HEADER => TUNNEL_LEN,
                DRIVE_HEADER => DRIVE_LEN,
                _ => {
                    self.discard();
                    continue;
                }
            };
            let frame = self.waiting.get(..length)?;
            if codec::crc8(&frame[..length - 1]) != frame[length - 1] {
                self.crc_errors += 1;
                self.discard();
                continue;
            }
            let found = <[u8; LEN]>::try_from(frame).ok();
            self.waiting.drain(..length);
            if found.is_some() {
                return found;
            }
        }
        None
    }

    fn discard(&mut self) {
        self.waiting.remove(0);
        self.discarded += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pc::codec::{DOWN_LEN, down_frame};

    fn found(bytes: &[u8]) -> (Vec<[u8; DOWN_LEN]>, Scanner<DOWN_LEN>) {
        let mut scanner = Scanner::default();
        let frames = bytes
            .iter()
            .filter_map(|byte| scanner.take(*byte))
            .collect();
        (frames, scanner)
    }

    #[test]
    fn a_frame_is_found_behind_a_false_header() {
        let frame = down_frame([[1, 2, 3]; 6]);
        let (frames, scanner) = found(&[&[0x55, HEADER, 7][..], &frame, &frame].concat());
        assert_eq!(frames, [frame, frame]);
        assert_eq!((scanner.discarded, scanner.crc_errors), (3, 1));
    }

    #[test]
    fn a_frame_of_the_tuning_channel_is_passed_over() {
        let mut tunnelled = [TUNNEL_HEADER, 0xA2, 0x87, 1, 2, 3, 4, 5, 6, 7, 8, 0];
        tunnelled[11] = codec::crc8(&tunnelled[..11]);
        let frame = down_frame([[9; 3]; 6]);
        let (frames, scanner) = found(&[&frame[..], &tunnelled, &frame].concat());
        assert_eq!(frames, [frame, frame]);
        assert_eq!((scanner.discarded, scanner.crc_errors), (0, 0));
    }

    #[test]
    fn one_changed_byte_costs_one_frame() {
        let frame = down_frame([[300; 3]; 6]);
        for place in 0..DOWN_LEN {
            let mut damaged = frame;
            damaged[place] ^= 0x10;
            let (frames, _) = found(&[frame, damaged, frame, frame].concat());
            assert!(frames.len() >= 2, "byte {place}");
            assert_eq!(frames.last(), Some(&frame));
        }
    }
}
