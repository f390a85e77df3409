//! Which bus, as the user names it.

use std::{convert::Infallible, fmt, path::PathBuf, str::FromStr};

use super::{CanLink, CanLinkError, slcan::Slcan};

/// Where the CAN bus is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CanDevice {
    /// A LAWICEL (slcan) adapter on a serial device, or a pseudo-terminal of the emulated board.
    Slcan(PathBuf),
    /// A network interface of Linux, already up at 1 Mbit/s.
    SocketCan(String),
}

impl FromStr for CanDevice {
    type Err = Infallible;

    /// A path or a COM port is a serial device; anything else the name of an interface.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        let is_serial = text.contains(['/', '\\']) || text.to_ascii_uppercase().starts_with("COM");
        Ok(if is_serial {
            Self::Slcan(text.into())
        } else {
            Self::SocketCan(text.to_owned())
        })
    }
}

impl fmt::Display for CanDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slcan(path) => path.display().fmt(f),
            Self::SocketCan(name) => name.fmt(f),
        }
    }
}

impl CanDevice {
    /// Opens the bus for sending and hearing.
    pub fn open(&self) -> Result<Box<dyn CanLink>, CanLinkError> {
        match self {
            Self::Slcan(path) => Ok(Box::new(Slcan::open(path)?)),
            #[cfg(target_os = "linux")]
            Self::SocketCan(name) => Ok(Box::new(super::socketcan::Interface::open(name)?)),
            #[cfg(not(target_os = "linux"))]
            Self::SocketCan(name) => Err(CanLinkError::Open {
                device: name.clone(),
                why: "network interfaces for CAN exist on Linux only; name the serial port of an slcan adapter, such as COM3"
                    .into(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_com_ports_are_serial_devices() {
        let device = |text: &str| text.parse::<CanDevice>().unwrap();
        assert_eq!(device("/dev/pts/3"), CanDevice::Slcan("/dev/pts/3".into()));
        assert_eq!(device("com7"), CanDevice::Slcan("com7".into()));
        assert_eq!(device("can0"), CanDevice::SocketCan("can0".into()));
    }
}
