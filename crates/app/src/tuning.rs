//! The tuning channel: reads and changes settings over CAN, or over the PC link, while the robot is disarmed
//! (docs/tuning.md).
//!
//! A request arrives with [`WRITE_ID`] or [`READ_ID`] at one of three ports and is answered with [`REPLY_ID`] at the
//! same port: see [`TuningPort`]. [`PARAMETERS`] lists all settings.

mod block;
mod channel;
pub(crate) mod consistency;
mod gate;
mod identifiers;
mod live;
pub mod opcode;
mod parameter;
mod parameters;
mod port;
mod protocol;
mod recording;
mod refusal;
mod wheel_geometry;

pub use block::{BlockFrame, BlockSender};
pub use channel::{TuningAccess, TuningChannel};
pub use gate::TuningGate;
pub use identifiers::{READ_ID, REPLY_ID, WRITE_ID};
pub use live::{JOINTS, LIVE_PAGES, LiveField, LiveKind, LivePage, LiveSource, LiveValue, WHEELS};
pub use parameter::{Parameter, ParameterGroup, ParameterKind, Scope};
pub use parameters::PARAMETERS;
pub(crate) use parameters::bit;
pub use port::TuningPort;
pub(crate) use protocol::is_request;
pub use recording::{
    MAX_RECORDING_S, RecordedSample, RecordedSensor, Recorder, RecordingState, RecordingStatus,
};
pub use refusal::Refusal;
