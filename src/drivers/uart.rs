//! UARTs by their registers: the two halves of a line start by themselves, after the format is set.

mod format;
mod receiver;
mod transmitter;

pub use format::{Parity, StopBits, UartFormat};
pub use receiver::{ErrorReports, UartLine, UartReceiver};
pub use transmitter::UartTransmitter;
