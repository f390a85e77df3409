//! The radio input stage: bytes from the receiver → sticks, switches and link quality.

mod channels;
mod dbus;
mod dbus_wheel;
mod glitch_filter;
mod line_diagnosis;
mod mapping;
mod receiver;
mod sbus;

pub use crate::domain::RemoteMapping;
pub use dbus::{DbusFrame, DbusParser, DbusSwitch};
pub use line_diagnosis::{LineCounters, LineDiagnosis};
pub use mapping::{SBUS_SWITCH_HIGH, SBUS_SWITCH_LOW};
pub use receiver::{RemoteFormat, RemoteReceiver};
pub use sbus::{SbusFrame, SbusParser};
