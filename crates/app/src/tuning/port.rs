//! Where a request comes from, and where its reply goes.

use crate::domain::BusId;

/// A way to the tuning channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TuningPort {
    /// A CAN bus.
    Bus(BusId),
    /// The tunnel of the PC link.
    Link,
}

impl TuningPort {
    /// Number of ports.
    pub const COUNT: usize = 3;

    /// Index of the port, below [`COUNT`](Self::COUNT).
    pub const fn index(self) -> usize {
        match self {
            Self::Bus(bus) => bus as usize,
            Self::Link => 2,
        }
    }
}
