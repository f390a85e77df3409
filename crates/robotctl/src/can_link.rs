//! Reaches a CAN bus from this computer through an slcan adapter, SocketCAN or a gateway to Ethernet.

mod device;
mod gateway;
mod lawicel;
mod named;
mod slcan;
#[cfg(target_os = "linux")]
mod socketcan;

use std::time::Instant;

use robot_app::domain::CanFrame;

pub use device::CanDevice;
pub use gateway::{GatewayAddress, GatewayAddressError};

/// A CAN bus. It carries data frames with 11-bit identifiers; frames of other kinds are ignored.
pub trait CanLink {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError>;

    /// Returns the next frame received, or `None` if there is none before `deadline`.
    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError>;

    /// Says what may be wrong if the robot does not answer.
    fn why_silent(&self) -> String {
        "is it on, is this one of its two CAN buses at 1 Mbit/s, and is the bus terminated?"
            .to_owned()
    }
}

#[derive(Debug, thiserror::Error)]
pub enum CanLinkError {
    #[error("cannot open {device}: {why}")]
    Open { device: String, why: String },
    #[cfg(not(target_os = "linux"))]
    #[error(
        "cannot open {device}: CAN interfaces exist on Linux only; name the serial port of an slcan adapter, such as \
         {example}"
    )]
    OnlyOnLinux {
        device: String,
        example: &'static str,
    },
    #[error(
        "the adapter at {device} refuses `{command}`: is another program using it, or does it not know 1 Mbit/s?"
    )]
    SetUp {
        device: String,
        command: &'static str,
    },
    #[error("{device} speaks the PC link, not slcan: use --link {device}")]
    SpeaksPcLink { device: String },
    #[error(
        "the adapter at {device} refused a frame: is the bus connected, powered and terminated?"
    )]
    FrameRefused { device: String },
    #[error("{device} failed: is it still plugged in?")]
    PortFailed {
        device: String,
        source: std::io::Error,
    },
    #[error("the PC link carries only the tuning channel, not a frame with identifier {id:#05x}")]
    NotTunnelled { id: u16 },
    #[error("no connection to the gateway {device}: {why}")]
    Gateway { device: String, why: String },
    #[error("the CAN adapter failed: is it still connected?")]
    Failed(#[from] std::io::Error),
}
