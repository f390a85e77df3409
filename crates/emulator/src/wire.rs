//! Frames and characters on the wires between the chip and its board.

pub use robot_wire::{CanFrame, LineEvent, LineFormat, Parity, UartChar};

/// The CAN controller of a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanPort {
    /// bxCAN 1, the master of the shared filters.
    Can1,
    /// bxCAN 2.
    Can2,
}

/// A USART that is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UartPort {
    /// USART1, on APB2.
    Usart1,
    /// USART3, on APB1.
    Usart3,
    /// USART6, on APB2.
    Usart6,
}
