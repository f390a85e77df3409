//! What crosses a wire between the emulated chip and the simulated world: CAN frames, UART characters, and their time.
//!
//! The chip (`robot-emulator`) and the world (`robot-plant`) do not know each other; both know these types.

#![deny(missing_docs)]

mod can;
pub mod time;
mod uart;

pub use can::CanFrame;
pub use uart::{LineEvent, LineFormat, Parity, UartChar};
