//! The part of the LAWICEL protocol (CAN232, CANUSB; "slcan") that this tool needs.

use robot_app::domain::{CanFrame, StandardId};

/// The adapter's answer to a command that it refuses.
const BELL: u8 = 0x07;
/// Longest line: `T`, eight digits, length, eight bytes, time stamp.
const LONGEST: usize = 1 + 8 + 1 + 16 + 4;

/// One message of an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Received {
    Frame(CanFrame),
    /// A command or frame was accepted.
    Done,
    /// A command or frame was refused.
    Refused,
}

/// Parses bytes into messages. It ignores frames of other kinds and anything unknown.
#[derive(Debug, Default)]
pub(super) struct LineParser {
    line: Vec<u8>,
}

impl LineParser {
    pub fn feed(&mut self, byte: u8) -> Option<Received> {
        match byte {
            BELL => {
                self.line.clear();
                Some(Received::Refused)
            }
            b'\r' => {
                let received = parse(&self.line);
                self.line.clear();
                received
            }
            _ => {
                // One byte more than fits is kept. It marks a line that is too long.
                if self.line.len() <= LONGEST {
                    self.line.push(byte);
                }
                None
            }
        }
    }
}

fn parse(line: &[u8]) -> Option<Received> {
    match line {
        [] | [b'z' | b'Z'] => Some(Received::Done),
        [b't', rest @ ..] => frame(rest).map(Received::Frame),
        _ => None,
    }
}

/// Parses an identifier of three digits, a length, and two digits for each byte. A time stamp of four digits may
/// follow.
fn frame(text: &[u8]) -> Option<CanFrame> {
    let text = std::str::from_utf8(text).ok().filter(|t| t.is_ascii())?;
    let id = u16::from_str_radix(text.get(..3)?, 16).ok()?;
    let length = usize::from_str_radix(text.get(3..4)?, 16).ok()?;
    let digits = text.get(4..4 + 2 * length)?;
    let stamp = text.len() - (4 + 2 * length);
    if stamp != 0 && stamp != 4 {
        return None;
    }
    let bytes: Option<Vec<u8>> = (0..length)
        .map(|n| u8::from_str_radix(digits.get(2 * n..2 * n + 2)?, 16).ok())
        .collect();
    CanFrame::from_payload(StandardId::new(id)?, &bytes?)
}

/// Returns the command that sends `frame`.
pub(super) fn transmit(frame: &CanFrame) -> String {
    let payload = frame.payload();
    let mut line = format!("t{:03X}{}", frame.id().raw(), payload.len());
    for byte in payload {
        line.push_str(&format!("{byte:02X}"));
    }
    line.push('\r');
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u16, payload: &[u8]) -> CanFrame {
        CanFrame::from_payload(StandardId::new(id).unwrap(), payload).unwrap()
    }

    fn received(bytes: &[u8]) -> Vec<Received> {
        let mut parser = LineParser::default();
        bytes.iter().filter_map(|b| parser.feed(*b)).collect()
    }

    // The manual's example: t10021133[CR] is ID 0x100 with the two bytes 0x11 and 0x33.
    #[test]
    fn the_example_of_the_manual_is_parsed_and_written() {
        let example = frame(0x100, &[0x11, 0x33]);
        assert_eq!(transmit(&example), "t10021133\r");
        assert_eq!(received(b"t10021133\r"), [Received::Frame(example)]);
    }

    #[test]
    fn answers_and_frames_are_distinguished() {
        let said = received(b"\rz\rt7A20\r\x07t2011FF EA60\rt20118812AB\r");
        assert_eq!(
            said,
            [
                Received::Done,
                Received::Done,
                Received::Frame(frame(0x7A2, &[])),
                Received::Refused,
                Received::Frame(frame(0x201, &[0x88])),
            ]
        );
    }

    #[test]
    fn extended_remote_and_broken_lines_are_ignored() {
        let broken: [&[u8]; 6] = [
            b"T0000010021133\r",
            b"r1002\r",
            b"t1003AABB\r",
            b"t1002AABBCC\r",
            b"t1009\r",
            b"V1013\r",
        ];
        for line in broken {
            assert_eq!(received(line), [], "{}", String::from_utf8_lossy(line));
        }
        let long = [b"t", [b'0'; 90].as_slice(), b"\rz\r"].concat();
        assert_eq!(received(&long), [Received::Done]);
    }
}
