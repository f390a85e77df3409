//! Frames of the bus: `FF FF ID LEN INSTRUCTION parameters CHECKSUM` from the host, and the same with an error byte in the
//! instruction's place from a servo. LEN counts what follows it. The checksum is the inverted sum of all from ID on.
//!
//! Source: the manufacturer's protocol manual and SDK (`feetech-servo-sdk`).

/// The id that all servos take a request for.
pub const BROADCAST: u8 = 0xFE;

const PING: u8 = 0x01;
const READ: u8 = 0x02;
const WRITE: u8 = 0x03;
const REG_WRITE: u8 = 0x04;
const ACTION: u8 = 0x05;
const SYNC_READ: u8 = 0x82;
const SYNC_WRITE: u8 = 0x83;

/// A frame with a right checksum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Whom it is for, 0 to 253, or [`BROADCAST`].
    pub id: u8,
    instruction: u8,
    parameters: Vec<u8>,
}

/// What a frame asks for.
#[derive(Debug, PartialEq, Eq)]
pub enum Request<'a> {
    Ping,
    Read {
        address: u8,
        length: u8,
    },
    Write {
        address: u8,
        data: &'a [u8],
    },
    RegWrite {
        address: u8,
        data: &'a [u8],
    },
    Action,
    SyncRead {
        address: u8,
        length: u8,
        ids: &'a [u8],
    },
    /// Each record is an id and the bytes for it.
    SyncWrite {
        address: u8,
        length: u8,
        records: &'a [u8],
    },
}

impl Frame {
    /// Returns the request. `None` if a servo knows no such instruction, or its parameters do not fit it.
    pub fn request(&self) -> Option<Request<'_>> {
        match (self.instruction, self.parameters.as_slice()) {
            (PING, []) => Some(Request::Ping),
            (READ, [address, length]) => Some(Request::Read {
                address: *address,
                length: *length,
            }),
            (WRITE, [address, data @ ..]) => Some(Request::Write {
                address: *address,
                data,
            }),
            (REG_WRITE, [address, data @ ..]) => Some(Request::RegWrite {
                address: *address,
                data,
            }),
            (ACTION, []) => Some(Request::Action),
            (SYNC_READ, [address, length, ids @ ..]) => Some(Request::SyncRead {
                address: *address,
                length: *length,
                ids,
            }),
            (SYNC_WRITE, [address, length, records @ ..]) => {
                let record = usize::from(*length) + 1;
                (*length > 0 && records.len() % record == 0).then_some(Request::SyncWrite {
                    address: *address,
                    length: *length,
                    records,
                })
            }
            _ => None,
        }
    }
}

/// Returns a servo's answer.
pub fn answer(id: u8, error: u8, data: &[u8]) -> Vec<u8> {
    // A frame holds no more than 253 bytes of data; the servo never reads more.
    let length = u8::try_from(data.len() + 2).unwrap_or(u8::MAX);
    let mut bytes = vec![0xFF, 0xFF, id, length, error];
    bytes.extend_from_slice(data);
    bytes.push(checksum(&bytes[2..]));
    bytes
}

fn checksum(bytes: &[u8]) -> u8 {
    !bytes.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte))
}

/// Finds frames in the bytes that a servo hears. A frame with a wrong checksum is dropped without a word.
#[derive(Clone, Debug, Default)]
pub struct Scanner {
    /// The frame so far, from its id on, once the header has passed.
    body: Vec<u8>,
    /// Bytes of the header that have passed.
    header: u8,
}

impl Scanner {
    /// Takes the next byte, and returns the frame that it completes.
    pub fn take(&mut self, byte: u8) -> Option<Frame> {
        if self.header < 2 {
            self.header = if byte == 0xFF { self.header + 1 } else { 0 };
            return None;
        }
        // A third FF is a header that began later.
        if self.body.is_empty() && byte == 0xFF {
            return None;
        }
        self.body.push(byte);
        let [id, length, ..] = *self.body.as_slice() else {
            return None;
        };
        let length = usize::from(length);
        if length < 2 {
            self.restart();
            return None;
        }
        if self.body.len() < 2 + length {
            return None;
        }
        let (sum, content) = self.body.split_last()?;
        let frame = (checksum(content) == *sum).then(|| Frame {
            id,
            instruction: content[2],
            parameters: content[3..].to_vec(),
        });
        self.restart();
        frame
    }

    /// Whether no frame has begun.
    pub fn is_between(&self) -> bool {
        self.header == 0
    }

    /// Forgets the frame that has begun.
    pub fn restart(&mut self) {
        self.body.clear();
        self.header = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(bytes: &[u8]) -> Vec<Frame> {
        let mut scanner = Scanner::default();
        bytes
            .iter()
            .filter_map(|byte| scanner.take(*byte))
            .collect()
    }

    // The bytes are computed by hand from the manufacturer's format.
    #[test]
    fn golden_requests_are_understood() {
        let ping = scan(&[0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB]);
        assert_eq!((ping[0].id, ping[0].request()), (1, Some(Request::Ping)));
        let read = scan(&[0xFF, 0xFF, 0x01, 0x04, 0x02, 0x38, 0x02, 0xBE]);
        let wanted = Request::Read {
            address: 56,
            length: 2,
        };
        assert_eq!(read[0].request(), Some(wanted));
        let torque = scan(&[0xFF, 0xFF, 0x01, 0x04, 0x03, 0x28, 0x01, 0xCE]);
        let wanted = Request::Write {
            address: 40,
            data: &[1],
        };
        assert_eq!(torque[0].request(), Some(wanted));
        let position = scan(&[
            0xFF, 0xFF, 0x01, 0x0A, 0x03, 0x29, 0x32, 0x00, 0x08, 0x00, 0x00, 0xE8, 0x03, 0xA3,
        ]);
        let wanted = Request::Write {
            address: 41,
            data: &[50, 0, 8, 0, 0, 0xE8, 3],
        };
        assert_eq!(position[0].request(), Some(wanted));
        let sync_read = scan(&[0xFF, 0xFF, 0xFE, 0x06, 0x82, 0x38, 0x08, 0x01, 0x02, 0x36]);
        assert_eq!(sync_read[0].id, BROADCAST);
        let wanted = Request::SyncRead {
            address: 56,
            length: 8,
            ids: &[1, 2],
        };
        assert_eq!(sync_read[0].request(), Some(wanted));
        let sync_write = scan(&[
            0xFF, 0xFF, 0xFE, 0x0A, 0x83, 0x2A, 0x02, 0x01, 0x00, 0x08, 0x02, 0x00, 0x04, 0x39,
        ]);
        let wanted = Request::SyncWrite {
            address: 42,
            length: 2,
            records: &[1, 0, 8, 2, 0, 4],
        };
        assert_eq!(sync_write[0].request(), Some(wanted));
    }

    #[test]
    fn a_wrong_checksum_is_dropped_and_the_next_frame_found() {
        let wrong_then_right = [
            0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFA, 0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB,
        ];
        assert_eq!(scan(&wrong_then_right).len(), 1);
        let after_rubbish = [0x00, 0xFF, 0x12, 0xFF, 0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB];
        assert_eq!(scan(&after_rubbish).len(), 1);
        assert_eq!(scan(&[0xFF, 0xFF, 0x01, 0x01, 0xFF, 0xFD]), []);
    }

    #[test]
    fn records_that_do_not_fit_their_length_are_no_request() {
        let cut = scan(&[0xFF, 0xFF, 0xFE, 0x06, 0x83, 0x2A, 0x02, 0x01, 0x00, 0x4B]);
        assert_eq!(cut.len(), 1);
        assert_eq!(cut[0].request(), None);
        assert_eq!(scan(&answer(1, 0, &[]))[0].request(), None);
    }

    #[test]
    fn an_answer_has_the_manufacturers_form() {
        assert_eq!(answer(1, 0, &[]), [0xFF, 0xFF, 0x01, 0x02, 0x00, 0xFC]);
        assert_eq!(
            answer(1, 0x20, &[0x00, 0x08]),
            [0xFF, 0xFF, 0x01, 0x04, 0x20, 0x00, 0x08, 0xD2]
        );
    }
}
