//! Radio bytes → sticks, switches and link quality.

mod channels;
mod confirmation;
mod dbus;
mod line_finding;
mod mapping;
mod receiver;
mod sbus;

pub use crate::domain::RemoteMapping;
pub use dbus::{DbusFrame, DbusParser, DbusSwitch};
pub use line_finding::{LineFinding, LineLook};
pub use receiver::{RemoteFormat, RemoteReceiver};
pub use sbus::{SbusFrame, SbusParser};
