//! Encoding of requests and replies, all little-endian.

use super::{
    MAX_RECORDING_S, PARAMETERS, ParameterGroup, RecordingStatus, Refusal, bit,
    identifiers::{READ_ID, REPLY_ID, WRITE_ID},
    live::PAGE_BYTES,
    opcode::{
        BRING_UP, READ_BLACK_BOX, READ_BLOCK, READ_FINDINGS, READ_GEOMETRY, READ_LIVE,
        READ_PARAMETER, READ_RECORDING, READ_STORE, RECORD, REFUSED, RELEASE_EVENT,
        RESTORE_DEFAULTS, WRITE_GEOMETRY, WRITE_PARAMETER, ZERO_JOINT,
    },
    wheel_geometry::WheelGeometry,
};
use crate::{
    black_box::{BANK_BYTES, LAYOUT_VERSION},
    bring_up::BringUpRequest,
    domain::{BankStatus, CanFrame, ParamState, ParamStatus},
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    WriteGeometry(WheelGeometry),
    ReadGeometry,
    WriteParameter {
        group: u8,
        index: u8,
        value: f32,
    },
    ReadParameter {
        group: u8,
        index: u8,
    },
    RestoreDefaults(Restored),
    ReadStore,
    ReadFindings,
    /// Reads the page with this number.
    ReadLive(u8),
    BringUp(BringUpRequest),
    /// Moves the zero of a joint so that its present angle becomes this angle.
    ZeroJoint {
        joint: u8,
        angle_rad: f32,
    },
    /// Records for this number of seconds; 0 ends a recording.
    Record(u16),
    ReadRecording,
    /// Asks what this bank of the black box holds.
    ReadBlackBox(u8),
    /// Reads a bank of the black box from this byte on.
    ReadBlock {
        bank: u8,
        at: u16,
        frames: u8,
    },
    /// Releases the event with this number.
    ReleaseEvent {
        bank: u8,
        number: u16,
    },
}

/// What is set to its defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restored {
    AllGroups,
    /// The group with this number.
    Group(u8),
}

impl Restored {
    pub fn covers(self, group: &ParameterGroup) -> bool {
        match self {
            Self::AllGroups => true,
            Self::Group(number) => number == group.number,
        }
    }
}

/// Whether a frame is for the tuning channel.
pub fn is_request(frame: &CanFrame) -> bool {
    frame.id() == WRITE_ID || frame.id() == READ_ID
}

impl Request {
    /// Decodes a request. Returns `None` for a frame that is not for the tuning channel.
    pub fn decode(frame: &CanFrame) -> Option<Result<Self, Refusal>> {
        let id = frame.id();
        if id == WRITE_ID {
            Some(Self::decode_write(frame))
        } else if id == READ_ID {
            Some(Self::decode_read(frame.payload()))
        } else {
            None
        }
    }

    /// Writes must have eight bytes.
    fn decode_write(frame: &CanFrame) -> Result<Self, Refusal> {
        let known = matches!(
            frame.payload(),
            [] | [
                WRITE_GEOMETRY
                    | WRITE_PARAMETER
                    | RESTORE_DEFAULTS
                    | BRING_UP
                    | ZERO_JOINT
                    | RECORD
                    | RELEASE_EVENT,
                ..
            ]
        );
        if !known {
            return Err(Refusal::UnknownCommand);
        }
        match frame.full_payload().ok_or(Refusal::WrongLength)? {
            [WRITE_GEOMETRY, geometry @ ..] => Ok(Self::WriteGeometry(WheelGeometry(geometry))),
            [WRITE_PARAMETER, group, index, 0, a, b, c, d] => Ok(Self::WriteParameter {
                group,
                index,
                value: f32::from_le_bytes([a, b, c, d]),
            }),
            [RESTORE_DEFAULTS, 0, 0, 0, 0, 0, 0, 0] => {
                Ok(Self::RestoreDefaults(Restored::AllGroups))
            }
            [RESTORE_DEFAULTS, group, 0, 0, 0, 0, 0, 0] => {
                Ok(Self::RestoreDefaults(Restored::Group(group)))
            }
            [BRING_UP, step, motor, action, low, high, 0, 0] => {
                let value = i16::from_le_bytes([low, high]);
                BringUpRequest::from_fields(step, motor, action, value)
                    .map(Self::BringUp)
                    .ok_or(Refusal::OutOfRange)
            }
            [ZERO_JOINT, joint, 0, 0, a, b, c, d] => Ok(Self::ZeroJoint {
                joint,
                angle_rad: f32::from_le_bytes([a, b, c, d]),
            }),
            [RECORD, low, high, 0, 0, 0, 0, 0] => match u16::from_le_bytes([low, high]) {
                seconds @ ..=MAX_RECORDING_S => Ok(Self::Record(seconds)),
                _ => Err(Refusal::OutOfRange),
            },
            [RELEASE_EVENT, bank, low, high, 0, 0, 0, 0] => Ok(Self::ReleaseEvent {
                bank,
                number: u16::from_le_bytes([low, high]),
            }),
            // A byte that must be 0 is not.
            _ => Err(Refusal::OutOfRange),
        }
    }

    /// Reads may be longer than needed, as many tools always send eight bytes.
    fn decode_read(payload: &[u8]) -> Result<Self, Refusal> {
        match *payload {
            [READ_GEOMETRY, ..] => Ok(Self::ReadGeometry),
            [READ_PARAMETER, group, index, ..] => Ok(Self::ReadParameter { group, index }),
            [READ_STORE, ..] => Ok(Self::ReadStore),
            [READ_FINDINGS, ..] => Ok(Self::ReadFindings),
            [READ_LIVE, page, ..] => Ok(Self::ReadLive(page)),
            [READ_RECORDING, ..] => Ok(Self::ReadRecording),
            [READ_BLACK_BOX, bank, ..] => Ok(Self::ReadBlackBox(bank)),
            [READ_BLOCK, bank, low, high, frames, ..] => Ok(Self::ReadBlock {
                bank,
                at: u16::from_le_bytes([low, high]),
                frames,
            }),
            [] | [READ_PARAMETER | READ_LIVE | READ_BLACK_BOX | READ_BLOCK, ..] => {
                Err(Refusal::WrongLength)
            }
            _ => Err(Refusal::UnknownCommand),
        }
    }
}

pub fn geometry_reply(geometry: WheelGeometry) -> CanFrame {
    let [a, b, c, d, e, f, g] = geometry.0;
    CanFrame::new(REPLY_ID, [READ_GEOMETRY, a, b, c, d, e, f, g])
}

pub fn parameter_reply(group: u8, index: u8, value: f32) -> CanFrame {
    let [a, b, c, d] = value.to_le_bytes();
    CanFrame::new(REPLY_ID, [READ_PARAMETER, group, index, 0, a, b, c, d])
}

/// State of the parameter store. `revision` is the present `TuningStatus::revision`; a revision that the store has
/// not seen yet counts as one more unsaved group.
pub fn store_reply(params: &ParamStatus, revision: u32) -> CanFrame {
    let overtaken = params.seen != revision;
    let state = if overtaken {
        ParamState::Settling
    } else {
        params.state
    };
    let unsaved = (params.unsaved.count_ones() as u8).saturating_add(u8::from(overtaken));
    let [ok_low, ok_high] = saturated(params.save_ok);
    let [failed_low, failed_high] = saturated(params.save_failed);
    CanFrame::new(
        REPLY_ID,
        [
            READ_STORE,
            state as u8,
            params.last_error as u8,
            unsaved,
            ok_low,
            ok_high,
            failed_low,
            failed_high,
        ],
    )
}

/// What boot found in the store. Bits of the mask are group numbers.
pub fn findings_reply(params: &ParamStatus) -> CanFrame {
    let mut refused: u32 = 0;
    for (position, group) in PARAMETERS.iter().enumerate() {
        if params.refused & bit(position) != 0 {
            refused |= 1u32.wrapping_shl(group.number.into());
        }
    }
    let [a, b, c, d] = refused.to_le_bytes();
    let count = |count| u8::try_from(count).unwrap_or(u8::MAX);
    let (damaged, foreign) = (count(params.damaged), count(params.foreign));
    CanFrame::new(
        REPLY_ID,
        [
            READ_FINDINGS,
            params.lost_sectors,
            damaged,
            foreign,
            a,
            b,
            c,
            d,
        ],
    )
}

pub fn live_reply(page: u8, [a, b, c, d, e, f]: [u8; PAGE_BYTES]) -> CanFrame {
    CanFrame::new(REPLY_ID, [READ_LIVE, page, a, b, c, d, e, f])
}

pub fn recording_reply(status: &RecordingStatus) -> CanFrame {
    let [a, b, c, _] = status.imu.to_le_bytes();
    let [d, e, f, _] = status.mag.to_le_bytes();
    let state = status.state as u8;
    CanFrame::new(REPLY_ID, [READ_RECORDING, state, a, b, c, d, e, f])
}

/// What a bank of the black box holds. The bank's size is in units of 256 bytes.
pub fn black_box_reply(bank: u8, status: &BankStatus, overwritten: u32) -> CanFrame {
    let [low, high] = status.number.to_le_bytes();
    CanFrame::new(
        REPLY_ID,
        [
            READ_BLACK_BOX,
            bank,
            status.state as u8 | (status.kind as u8) << 4,
            low,
            high,
            (BANK_BYTES / 256) as u8,
            LAYOUT_VERSION,
            u8::try_from(overwritten).unwrap_or(u8::MAX),
        ],
    )
}

fn saturated(count: u32) -> [u8; 2] {
    u16::try_from(count).unwrap_or(u16::MAX).to_le_bytes()
}

/// An executed write is answered with its own bytes.
pub fn echo(request: &CanFrame) -> CanFrame {
    let mut data = [0; 8];
    for (byte, sent) in data.iter_mut().zip(request.payload()) {
        *byte = *sent;
    }
    CanFrame::new(REPLY_ID, data)
}

/// Names the refused request by its command, and group and index or page if it has them.
pub fn refusal_reply(request: &CanFrame, reason: Refusal) -> CanFrame {
    let byte = |place| request.payload().get(place).copied().unwrap_or(0);
    let command = byte(0);
    let (group, index) = match command {
        WRITE_PARAMETER | READ_PARAMETER => (byte(1), byte(2)),
        READ_LIVE => (byte(1), 0),
        _ => (0, 0),
    };
    CanFrame::new(
        REPLY_ID,
        [REFUSED, command, reason.code(), group, index, 0, 0, 0],
    )
}
