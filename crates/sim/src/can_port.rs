//! A CAN bus of the robot as programs on this computer find it.

use std::{
    fmt, io,
    net::SocketAddr,
    path::{Path, PathBuf},
};

use robot_plant::world::{CanBusId, World};

/// An adapter on a bus, which a program outside of the simulation can use.
pub trait CanPort {
    fn bus(&self) -> CanBusId;

    /// The device that a program opens.
    fn device(&self) -> CanDevice;

    fn stats(&self) -> PortStats;

    /// Carries out what programs asked for since the last call, and passes frames of the bus on. It never waits.
    fn serve(&mut self, world: &mut World) -> io::Result<()>;
}

/// A device as `robotctl --can` takes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CanDevice {
    /// A LAWICEL adapter.
    Terminal(PathBuf),
    /// One of the ports of a CAN-to-Ethernet gateway.
    Gateway(Protocol, SocketAddr),
}

impl CanDevice {
    /// The file to open, if it is one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Terminal(path) => Some(path),
            Self::Gateway(..) => None,
        }
    }
}

impl fmt::Display for CanDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Terminal(path) => path.display().fmt(f),
            Self::Gateway(protocol, address) => write!(f, "{protocol}:{address}"),
        }
    }
}

/// How a gateway is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    Tcp,
    Udp,
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tcp => "tcp",
            Self::Udp => "udp",
        })
    }
}

/// Frames between the bus and the PC since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct PortStats {
    pub to_pc: u64,
    pub from_pc: u64,
    /// Frames received while the PC did not read.
    pub dropped: u64,
    /// Frames of the PC that were refused because too many wait for the bus.
    pub refused: u64,
    /// Frames of the PC that no CAN frame corresponds to.
    pub malformed: u64,
}
