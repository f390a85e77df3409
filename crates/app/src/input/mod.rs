//! Radio bytes → sticks, switches and link quality.

mod channels;
mod confirmation;
mod dbus;
mod mapping;
mod receiver;
mod sbus;

pub use crate::domain::RemoteMapping;
pub use dbus::{DbusFrame, DbusParser, DbusSwitch};
pub use receiver::{RemoteFormat, RemoteReceiver};
pub use sbus::{SbusFrame, SbusParser};
