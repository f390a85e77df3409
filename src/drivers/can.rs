//! CAN1 and CAN2: the bxCAN peripherals at 1 Mb/s.
//!
//! Receive interrupts move frames into queues. The control tick drains them and fills the transmit mailboxes. Nothing here
//! waits for the bus.

mod bring_up;
mod link;
mod peripherals;
mod port;
mod receive;
pub mod transmit;

pub use bring_up::start;
pub use peripherals::{Can1, Can2};
pub use port::CanPort;
pub use receive::FifoInterrupt;
