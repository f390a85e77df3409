//! The two ways to the robot: a CAN bus and the PC link.

use crate::{
    can_link::{CanDevice, CanLink, CanLinkError},
    pc_link::PcLink,
};

/// The way to the robot's tuning channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transport {
    /// A CAN bus.
    Can(CanDevice),
    /// The serial port of the PC link, which carries the tuning channel too.
    Link(String),
}

impl Transport {
    pub fn open(&self) -> Result<Box<dyn CanLink>, CanLinkError> {
        match self {
            Self::Can(device) => device.open(),
            Self::Link(port) => Ok(Box::new(PcLink::open(port)?)),
        }
    }
}
