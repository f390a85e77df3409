//! Frames and characters on the wires between the chip and its board.

pub use robot_wire::{CanFrame, LineFormat, Parity, UartChar};

/// The CAN controller of a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanPort {
    /// bxCAN 1, the master of the shared filters.
    Can1,
    /// bxCAN 2.
    Can2,
}
