//! What can go wrong on the bus, with what to do about it.

use std::fmt;

use super::{register::Register, wire::WireError};

#[derive(Debug, thiserror::Error)]
pub enum BusError {
    /// The port itself failed; no servo can be reached.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// One servo did not do what was asked; the others can be.
    #[error(transparent)]
    Servo(#[from] ServoError),
    #[error("{register} = {value}: a servo's {register} takes {} to {}", .register.range().start(), .register.range().end())]
    Value { register: Register, value: i32 },
    #[error("{register} is read only: nothing was written")]
    ReadOnly { register: Register },
    #[error(
        "{register} does not follow the register before it: registers that are written at once are neighbours"
    )]
    NotNeighbours { register: Register },
    #[error("{id} is no servo's id: ids are 0 to 253")]
    Id { id: u8 },
    #[error("one frame holds at most 253 bytes: ask for fewer servos or registers at once")]
    TooLong,
    #[error("there is nothing to write")]
    Nothing,
}

/// A question to a servo without a usable answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServoError {
    pub id: u8,
    /// The joint's name, where the bus was told.
    pub joint: Option<String>,
    /// What was asked, such as `read present_position`.
    pub asked: String,
    pub tries: u32,
    pub cause: Cause,
}

impl std::error::Error for ServoError {}

impl fmt::Display for ServoError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            id,
            asked,
            tries,
            cause,
            ..
        } = self;
        match &self.joint {
            Some(joint) => write!(f, "servo {id} ({joint})")?,
            None => write!(f, "servo {id}")?,
        }
        match tries {
            1 => write!(f, ", {asked}: {cause}"),
            _ => write!(f, ", {asked}, asked {tries} times: {cause}"),
        }
    }
}

/// Why there is no usable answer; the last try counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    NoAnswer,
    /// Bytes came, but no whole frame.
    Damaged,
    /// Another servo answered, and this one did not.
    OtherServo {
        id: u8,
    },
    /// It answered with so many bytes of data.
    OtherLength {
        wanted: usize,
        came: usize,
    },
    /// It holds another value after the write.
    NotKept {
        wanted: i32,
        has: i32,
    },
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAnswer => write!(
                f,
                "no answer. Is its supply on, is its cable in at both ends, and has it this id and baud rate? `armctl scan` \
                 lists who answers"
            ),
            Self::Damaged => write!(
                f,
                "its answer is damaged. Two servos with one id talk at once: connect this one alone and give it another id \
                 (`armctl set-id`). Or a plug is loose, or the supply sags under load"
            ),
            Self::OtherServo { id } => write!(
                f,
                "servo {id} answered in its place: does another program use this port, or was an id changed? `armctl scan` \
                 lists who answers"
            ),
            Self::OtherLength { wanted, came } => write!(
                f,
                "it answered with {came} bytes instead of {wanted}: is it another kind of servo, or does another program use \
                 this port?"
            ),
            Self::NotKept { wanted, has } => write!(
                f,
                "it was told {wanted} and holds {has}. Is the value within what this servo's firmware takes?"
            ),
        }
    }
}
