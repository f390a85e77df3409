//! Where frames are in a stream, by the rules of docs/pc-link.md.

/// Direction of a stream, which decides how long a frame with header 0xFE is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    ToRobot,
    ToPc,
}

impl Direction {
    pub const fn long_frame(self) -> usize {
        match self {
            Self::ToRobot => 38,
            Self::ToPc => 94,
        }
    }

    fn frame_len(self, header: u8) -> Option<usize> {
        match header {
            0xFE => Some(self.long_frame()),
            0xFD => Some(12),
            0xFC if self == Self::ToRobot => Some(12),
            _ => None,
        }
    }
}

/// A frame in a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub start: usize,
    pub len: usize,
    /// It begins where the stream or another frame left off.
    pub contiguous: bool,
}

/// What a receiver must find and count.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    pub frames: Vec<Place>,
    pub discarded_bytes: u32,
}

/// Searches a whole stream. It ends at a header whose frame is not complete.
pub fn search(stream: &[u8], direction: Direction) -> Verdict {
    let mut verdict = Verdict::default();
    // True at places where a frame has ended, and of bytes that are part of one.
    let mut ends = vec![false; stream.len() + 1];
    let mut covered = 0;
    ends[0] = true;
    let mut at = 0;
    while at < stream.len() {
        let len = direction.frame_len(stream[at]);
        if len.is_some_and(|len| at + len > stream.len()) {
            break;
        }
        let frame = len.map(|len| &stream[at..at + len]);
        let Some(frame) = frame.filter(|frame| is_frame(frame)) else {
            verdict.discarded_bytes += u32::from(at >= covered);
            at += 1;
            continue;
        };
        let contiguous = ends[at];
        verdict.frames.push(Place {
            start: at,
            len: frame.len(),
            contiguous,
        });
        ends[at + frame.len()] = true;
        covered = covered.max(at + frame.len());
        at += if contiguous { frame.len() } else { 1 };
    }
    verdict
}

/// CRC and, in a tunnel frame, identifier, length and padding are right. A drive frame has one bit with a meaning.
fn is_frame(bytes: &[u8]) -> bool {
    let (crc, before) = bytes.split_last().unwrap();
    let is_sound = match bytes[0] {
        0xFD => is_tuning_frame(bytes),
        0xFC => bytes[9] <= 1,
        _ => true,
    };
    crc8(before) == *crc && is_sound
}

fn is_tuning_frame(bytes: &[u8]) -> bool {
    let id = u16::from(bytes[1]) | u16::from(bytes[2] & 0x0F) << 8;
    let len = usize::from(bytes[2] >> 4);
    id & 0xFF0 == 0x7A0 && len <= 8 && bytes[3 + len..11].iter().all(|byte| *byte == 0)
}

/// CRC-8/MAXIM-DOW bit by bit.
pub fn crc8(bytes: &[u8]) -> u8 {
    let mut crc = 0;
    for byte in bytes {
        for bit in 0..8 {
            let feedback = (crc ^ byte >> bit) & 1;
            crc = (crc >> 1) ^ (feedback * 0x8C);
        }
    }
    crc
}

#[test]
fn the_crc_has_the_catalogues_check_value() {
    assert_eq!(crc8(b"123456789"), 0xA1);
}
