//! The name that a user gives to a bus.

use std::{fmt, str::FromStr};

use super::{
    CanLink, CanLinkError, GatewayAddress, GatewayAddressError,
    gateway::Gateway,
    named::{Named, named},
    slcan::Slcan,
};

/// The device through which a CAN bus is reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CanDevice {
    /// The serial port of a LAWICEL (slcan) adapter, or a pseudo-terminal of the emulated board.
    Slcan(String),
    /// A CAN interface of Linux, already up at 1 Mbit/s.
    SocketCan(String),
    /// A gateway to Ethernet.
    Gateway(GatewayAddress),
}

impl FromStr for CanDevice {
    type Err = GatewayAddressError;

    /// Takes `tcp:HOST:PORT` and `udp:HOST:PORT` as a gateway and refuses an address without either, takes a path (`/dev/ttyACM0`) or a COM port (`COM3`) as a serial
    /// port, and anything else as the name of an interface.
    fn from_str(text: &str) -> Result<Self, GatewayAddressError> {
        if let Some(gateway) = GatewayAddress::parse(text) {
            return gateway.map(Self::Gateway);
        }
        let is_serial = text.contains(['/', '\\']) || is_com_port(text);
        let device = if is_serial {
            Self::Slcan
        } else {
            Self::SocketCan
        };
        Ok(device(text.to_owned()))
    }
}

fn is_com_port(text: &str) -> bool {
    let number = text.get(3..).filter(|number| !number.is_empty());
    let is_number = number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
    is_number && text.to_ascii_uppercase().starts_with("COM")
}

impl fmt::Display for CanDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slcan(name) | Self::SocketCan(name) => name.fmt(f),
            Self::Gateway(address) => address.fmt(f),
        }
    }
}

impl CanDevice {
    /// Opens the bus to send and receive.
    pub fn open(&self) -> Result<Box<dyn CanLink>, CanLinkError> {
        let device = self.to_string();
        let link = self.open_link().map_err(|error| named(&device, error))?;
        Ok(Box::new(Named { device, link }))
    }

    fn open_link(&self) -> Result<Box<dyn CanLink>, CanLinkError> {
        match self {
            Self::Slcan(port) => Ok(Box::new(Slcan::open(port)?)),
            Self::Gateway(address) => Ok(Box::new(Gateway::open(address)?)),
            #[cfg(target_os = "linux")]
            Self::SocketCan(name) => Ok(Box::new(super::socketcan::Interface::open(name)?)),
            #[cfg(not(target_os = "linux"))]
            Self::SocketCan(name) => Err(CanLinkError::OnlyOnLinux {
                device: name.clone(),
                example: super::slcan::EXAMPLE_PORT,
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
        let names = [
            "/dev/ttyACM0",
            "/dev/cu.usbmodem1101",
            "/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1",
            "COM3",
            "com17",
            r"\\.\COM17",
        ];
        for name in names {
            assert_eq!(device(name), CanDevice::Slcan(name.into()));
        }
        for name in ["can0", "com", "company0"] {
            assert_eq!(device(name), CanDevice::SocketCan(name.into()));
        }
    }

    #[test]
    fn gateways_are_written_back_as_they_were_read() {
        for text in [
            "tcp:192.168.0.7:20001",
            "udp:gateway.local:20002",
            "tcp:[fe80::1%eth0]:20001",
        ] {
            let device = text.parse::<CanDevice>().unwrap();
            assert!(matches!(device, CanDevice::Gateway(_)), "{text}");
            assert_eq!(device.to_string(), text);
        }
    }

    #[test]
    fn half_an_address_is_refused_with_an_example() {
        for text in [
            "tcp:",
            "tcp:20001",
            "udp:192.168.0.7",
            "udp:192.168.0.7:0",
            "tcp::20001",
            "tcp:gateway:70000",
        ] {
            let error = text.parse::<CanDevice>().unwrap_err().to_string();
            let example = format!("{}:192.168.0.7:20001", &text[..3]);
            assert!(error.contains(&example), "{error}");
        }
        for text in ["192.168.0.7:20001", "192.168.0.7", "gateway.local:20001"] {
            let error = text.parse::<CanDevice>().unwrap_err().to_string();
            assert!(error.contains(&format!("write tcp:{text}")), "{error}");
            assert!(error.contains(&format!(" or udp:{text}")), "{error}");
        }
    }
}
