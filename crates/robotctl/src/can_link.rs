//! Ways from this computer to a CAN bus.

mod device;
mod lawicel;
mod slcan;
#[cfg(target_os = "linux")]
mod socketcan;

use std::time::Instant;

use robot_app::domain::CanFrame;

pub use device::CanDevice;

/// A bus on which data frames with 11-bit identifiers are sent and heard; other frames are passed over.
pub trait CanLink {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError>;

    /// The next frame heard; `None` if there is none until `deadline`.
    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError>;
}

#[derive(Debug, thiserror::Error)]
pub enum CanLinkError {
    #[error("cannot open {device}: {why}")]
    Open { device: String, why: String },
    #[error(
        "the adapter refuses `{command}`: is another program using it, or does it not know 1 Mbit/s?"
    )]
    SetUp { command: &'static str },
    #[error("the adapter refused a frame: is the bus connected, powered and terminated?")]
    FrameRefused,
    #[error("the CAN adapter failed: is it still connected?")]
    Failed(#[from] std::io::Error),
}
