//! The bytes of requests and replies.

use robot_app::{
    domain::CanFrame,
    tuning::{
        READ_ID, REPLY_ID, Refusal, WRITE_ID,
        opcode::{
            BRING_UP, READ_BLACK_BOX, READ_BLOCK, READ_FINDINGS, READ_GEOMETRY, READ_LIVE,
            READ_PARAMETER, READ_RECORDING, READ_STORE, RECORD, REFUSED, RELEASE_EVENT,
            RESTORE_DEFAULTS, WRITE_GEOMETRY, WRITE_PARAMETER, ZERO_JOINT,
        },
    },
};

/// A request. It recognises its reply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Request {
    Read {
        group: u8,
        index: u8,
    },
    Write {
        group: u8,
        index: u8,
        value: f32,
    },
    ReadGeometry,
    /// The bytes after the command.
    WriteGeometry([u8; 7]),
    /// Number of the group; 0 means all.
    RestoreDefaults(u8),
    ReadStore,
    ReadFindings,
    /// The page's number.
    ReadLive(u8),
    /// The bytes after the command.
    BringUp([u8; 7]),
    ZeroJoint {
        joint: u8,
        angle_rad: f32,
    },
    /// Seconds.
    Record(u16),
    ReadRecording,
    /// The bank.
    ReadBlackBox(u8),
    ReadBlock {
        bank: u8,
        at: u16,
        frames: u8,
    },
    ReleaseEvent {
        bank: u8,
        number: u16,
    },
}

/// The robot's reply to a request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reply {
    /// The bytes after the command or, for a setting, after its address.
    Done([u8; 7]),
    /// The reason; `Err` is a number that this tool does not know.
    Refused(Result<Refusal, u8>),
}

impl Request {
    pub fn frame(&self) -> CanFrame {
        match *self {
            Self::Read { group, index } => {
                CanFrame::new(READ_ID, [READ_PARAMETER, group, index, 0, 0, 0, 0, 0])
            }
            Self::Write {
                group,
                index,
                value,
            } => {
                let [a, b, c, d] = value.to_le_bytes();
                CanFrame::new(WRITE_ID, [WRITE_PARAMETER, group, index, 0, a, b, c, d])
            }
            Self::ReadGeometry => CanFrame::new(READ_ID, [READ_GEOMETRY, 0, 0, 0, 0, 0, 0, 0]),
            Self::WriteGeometry(bytes) => write(WRITE_GEOMETRY, bytes),
            Self::RestoreDefaults(group) => write(RESTORE_DEFAULTS, [group, 0, 0, 0, 0, 0, 0]),
            Self::ReadStore => CanFrame::new(READ_ID, [READ_STORE, 0, 0, 0, 0, 0, 0, 0]),
            Self::ReadFindings => CanFrame::new(READ_ID, [READ_FINDINGS, 0, 0, 0, 0, 0, 0, 0]),
            Self::ReadLive(page) => CanFrame::new(READ_ID, [READ_LIVE, page, 0, 0, 0, 0, 0, 0]),
            Self::BringUp(bytes) => write(BRING_UP, bytes),
            Self::ZeroJoint { joint, angle_rad } => {
                let [a, b, c, d] = angle_rad.to_le_bytes();
                write(ZERO_JOINT, [joint, 0, 0, a, b, c, d])
            }
            Self::Record(seconds) => {
                let [low, high] = seconds.to_le_bytes();
                write(RECORD, [low, high, 0, 0, 0, 0, 0])
            }
            Self::ReadBlackBox(bank) => {
                CanFrame::new(READ_ID, [READ_BLACK_BOX, bank, 0, 0, 0, 0, 0, 0])
            }
            Self::ReadBlock { bank, at, frames } => {
                let [low, high] = at.to_le_bytes();
                CanFrame::new(READ_ID, [READ_BLOCK, bank, low, high, frames, 0, 0, 0])
            }
            Self::ReleaseEvent { bank, number } => {
                let [low, high] = number.to_le_bytes();
                write(RELEASE_EVENT, [bank, low, high, 0, 0, 0, 0])
            }
            Self::ReadRecording => CanFrame::new(READ_ID, [READ_RECORDING, 0, 0, 0, 0, 0, 0, 0]),
        }
    }

    /// Returns `None` if `frame` is not the reply to this request.
    pub fn reply(&self, frame: &CanFrame) -> Option<Reply> {
        if frame.id() != REPLY_ID {
            return None;
        }
        let asked = self.frame().full_payload()?;
        let [command, rest @ ..] = frame.full_payload()?;
        if command == REFUSED {
            let [refused, reason, group, index, ..] = rest;
            // A firmware that does not know the command does not know its operands either.
            let ours = self.address() == [group, index] || reason == Refusal::UnknownCommand.code();
            let ours = refused == asked[0] && ours;
            let reason = Refusal::from_code(reason).ok_or(reason);
            return ours.then_some(Reply::Refused(reason));
        }
        let ours = match self {
            Self::Read { .. } => frame.payload().starts_with(&asked[..4]),
            Self::ReadLive(_) | Self::ReadBlackBox(_) => frame.payload().starts_with(&asked[..2]),
            Self::ReadGeometry | Self::ReadStore | Self::ReadFindings | Self::ReadRecording => {
                command == asked[0]
            }
            Self::Write { .. }
            | Self::WriteGeometry(_)
            | Self::RestoreDefaults(_)
            | Self::BringUp(_)
            | Self::ZeroJoint { .. }
            | Self::Record(_)
            | Self::ReadBlock { .. }
            | Self::ReleaseEvent { .. } => frame.payload() == asked,
        };
        ours.then_some(Reply::Done(rest))
    }

    /// Returns the group and index, or the page, as a refusal repeats them.
    fn address(&self) -> [u8; 2] {
        match *self {
            Self::Read { group, index } | Self::Write { group, index, .. } => [group, index],
            Self::ReadLive(page) => [page, 0],
            Self::ReadGeometry
            | Self::WriteGeometry(_)
            | Self::RestoreDefaults(_)
            | Self::ReadStore
            | Self::ReadFindings
            | Self::ReadRecording
            | Self::ReadBlackBox(_)
            | Self::ReadBlock { .. }
            | Self::ReleaseEvent { .. }
            | Self::BringUp(_)
            | Self::ZeroJoint { .. }
            | Self::Record(_) => [0, 0],
        }
    }
}

fn write(command: u8, [a, b, c, d, e, f, g]: [u8; 7]) -> CanFrame {
    CanFrame::new(WRITE_ID, [command, a, b, c, d, e, f, g])
}

/// Returns the value in the reply to a request that reads a setting.
pub(super) fn value(reply: [u8; 7]) -> f32 {
    let [_, _, _, a, b, c, d] = reply;
    f32::from_le_bytes([a, b, c, d])
}

#[cfg(test)]
mod tests {
    use robot_app::domain::StandardId;

    use super::*;

    fn frame(id: u16, data: [u8; 8]) -> CanFrame {
        CanFrame::new(StandardId::new(id).unwrap(), data)
    }

    // Bytes by hand from docs/tuning.md: 0.25 is 0x3E800000.
    const WRITE: Request = Request::Write {
        group: 2,
        index: 5,
        value: 0.25,
    };
    const WRITE_BYTES: [u8; 8] = [0x20, 2, 5, 0, 0, 0, 0x80, 0x3E];
    const READ: Request = Request::Read { group: 2, index: 5 };

    #[test]
    fn requests_are_the_documented_bytes() {
        assert_eq!(WRITE.frame(), frame(0x7A0, WRITE_BYTES));
        assert_eq!(READ.frame(), frame(0x7A1, [0x21, 2, 5, 0, 0, 0, 0, 0]));
        assert_eq!(
            Request::ReadGeometry.frame().payload(),
            [0x11, 0, 0, 0, 0, 0, 0, 0]
        );
        let geometry = [0x50, 0, 0x2C, 0x01, 0x80, 0x07, 0x02];
        assert_eq!(
            Request::WriteGeometry(geometry).frame(),
            frame(0x7A0, [0x10, 0x50, 0, 0x2C, 0x01, 0x80, 0x07, 0x02])
        );
    }

    #[test]
    fn defaults_and_store_are_the_documented_bytes() {
        assert_eq!(
            Request::RestoreDefaults(7).frame(),
            frame(0x7A0, [0x30, 7, 0, 0, 0, 0, 0, 0])
        );
        let ask = Request::ReadStore;
        assert_eq!(ask.frame(), frame(0x7A1, [0x31, 0, 0, 0, 0, 0, 0, 0]));
        let reply = frame(0x7A2, [0x31, 5, 2, 1, 0x2C, 0x01, 3, 0]);
        let bytes = [5, 2, 1, 0x2C, 0x01, 3, 0];
        assert_eq!(ask.reply(&reply), Some(Reply::Done(bytes)));
        assert_eq!(ask.reply(&frame(0x7A2, [0x30; 8])), None);
    }

    /// Page 7.
    #[test]
    fn a_live_page_is_the_documented_bytes() {
        let ask = Request::ReadLive(7);
        assert_eq!(ask.frame(), frame(0x7A1, [0x33, 7, 0, 0, 0, 0, 0, 0]));
        let reply = frame(0x7A2, [0x33, 7, 0xDA, 0x2F, 0, 0, 0, 0]);
        let bytes = [7, 0xDA, 0x2F, 0, 0, 0, 0];
        assert_eq!(ask.reply(&reply), Some(Reply::Done(bytes)));
        assert_eq!(Request::ReadLive(8).reply(&reply), None);
        let refusal = frame(0x7A2, [0xEE, 0x33, 3, 7, 0, 0, 0, 0]);
        let refused = Some(Reply::Refused(Ok(Refusal::UnknownParameter)));
        assert_eq!(ask.reply(&refusal), refused);
        assert_eq!(Request::ReadLive(8).reply(&refusal), None);
    }

    /// −0.5 is 0xBF000000; 90 s.
    #[test]
    fn a_zero_and_a_recording_are_the_documented_bytes() {
        let zero = Request::ZeroJoint {
            joint: 3,
            angle_rad: -0.5,
        };
        assert_eq!(zero.frame(), frame(0x7A0, [0x41, 3, 0, 0, 0, 0, 0, 0xBF]));
        let record = Request::Record(90);
        assert_eq!(record.frame(), frame(0x7A0, [0x42, 90, 0, 0, 0, 0, 0, 0]));
        let ask = Request::ReadRecording;
        assert_eq!(ask.frame(), frame(0x7A1, [0x43, 0, 0, 0, 0, 0, 0, 0]));
        let reply = frame(0x7A2, [0x43, 1, 2, 0, 0, 1, 0, 0]);
        let bytes = [1, 2, 0, 0, 1, 0, 0];
        assert_eq!(ask.reply(&reply), Some(Reply::Done(bytes)));
    }

    #[test]
    fn requests_for_the_black_box_are_the_documented_bytes() {
        let ask = Request::ReadBlackBox(1);
        assert_eq!(ask.frame(), frame(0x7A1, [0x44, 1, 0, 0, 0, 0, 0, 0]));
        let reply = frame(0x7A2, [0x44, 1, 0x23, 3, 2, 56, 1, 0]);
        let bytes = [1, 0x23, 3, 2, 56, 1, 0];
        assert_eq!(ask.reply(&reply), Some(Reply::Done(bytes)));
        assert_eq!(Request::ReadBlackBox(0).reply(&reply), None);
        let read = Request::ReadBlock {
            bank: 1,
            at: 0x1234,
            frames: 253,
        };
        let bytes = [0x45, 1, 0x34, 0x12, 253, 0, 0, 0];
        assert_eq!(read.frame(), frame(0x7A1, bytes));
        assert!(read.reply(&frame(0x7A2, bytes)).is_some());
        let release = Request::ReleaseEvent {
            bank: 1,
            number: 0x0203,
        };
        assert_eq!(release.frame(), frame(0x7A0, [0x46, 1, 3, 2, 0, 0, 0, 0]));
    }

    #[test]
    fn only_the_reply_to_this_request_is_taken() {
        let answer = frame(0x7A2, [0x21, 2, 5, 0, 0, 0, 0x80, 0x3E]);
        let Some(Reply::Done(bytes)) = READ.reply(&answer) else {
            panic!("it is the reply");
        };
        assert_eq!(value(bytes), 0.25);
        assert!(WRITE.reply(&frame(0x7A2, WRITE_BYTES)).is_some());
        let others = [
            frame(0x7A1, [0x21, 2, 5, 0, 0, 0, 0x80, 0x3E]),
            frame(0x7A2, [0x21, 2, 6, 0, 0, 0, 0x80, 0x3E]),
            frame(0x7A2, [0x11, 2, 5, 0, 0, 0, 0x80, 0x3E]),
            frame(0x7A2, [0xEE, 0x20, 5, 2, 5, 0, 0, 0]),
            frame(0x7A2, [0xEE, 0x21, 5, 2, 6, 0, 0, 0]),
        ];
        for other in others {
            assert_eq!(READ.reply(&other), None, "{other:?}");
        }
    }

    #[test]
    fn a_refusal_names_its_reason() {
        let refusal = frame(0x7A2, [0xEE, 0x20, 5, 2, 5, 0, 0, 0]);
        let unknown = frame(0x7A2, [0xEE, 0x20, 99, 2, 5, 0, 0, 0]);
        assert_eq!(
            WRITE.reply(&refusal),
            Some(Reply::Refused(Ok(Refusal::Armed)))
        );
        assert_eq!(WRITE.reply(&unknown), Some(Reply::Refused(Err(99))));
        let of_geometry = frame(0x7A2, [0xEE, 0x11, 1, 0, 0, 0, 0, 0]);
        assert_eq!(
            Request::ReadGeometry.reply(&of_geometry),
            Some(Reply::Refused(Ok(Refusal::WrongLength)))
        );
    }
}
