//! Where the gateway is reached.

use std::{
    fmt,
    net::{Ipv4Addr, SocketAddr},
    str::FromStr,
};

use crate::can_port::Protocol;

/// Where the gateway is reached: CAN1 at this port, CAN2 at the next one. Port 0 stands for any two free ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GatewayAddress {
    pub(super) protocol: Protocol,
    pub(super) can1: SocketAddr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GatewayAddressError {
    #[error("begin with tcp: or udp:, as in tcp:20001")]
    Protocol,
    #[error(
        "write a port, as in tcp:20001, or an address of this computer and a port, as in tcp:0.0.0.0:20001"
    )]
    Address,
    #[error("CAN2 gets the next port, and there is none after 65535")]
    LastPort,
}

impl FromStr for GatewayAddress {
    type Err = GatewayAddressError;

    /// Takes `tcp:PORT` or `udp:PORT` on the loopback interface, and `tcp:ADDRESS:PORT` on another one.
    fn from_str(text: &str) -> Result<Self, GatewayAddressError> {
        let (protocol, place) = text.split_once(':').ok_or(GatewayAddressError::Protocol)?;
        let protocol = match protocol {
            "tcp" => Protocol::Tcp,
            "udp" => Protocol::Udp,
            _ => return Err(GatewayAddressError::Protocol),
        };
        let on_loopback = place.parse().map(|port| (Ipv4Addr::LOCALHOST, port).into());
        let can1: SocketAddr = on_loopback
            .or_else(|_| place.parse())
            .map_err(|_| GatewayAddressError::Address)?;
        if can1.port() == u16::MAX {
            return Err(GatewayAddressError::LastPort);
        }
        Ok(Self { protocol, can1 })
    }
}

impl fmt::Display for GatewayAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.protocol, self.can1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_an_address_the_gateway_is_on_this_computer_only() {
        let text = |address: &str| address.parse().map(|a: GatewayAddress| a.to_string());
        assert_eq!(text("tcp:20001"), Ok("tcp:127.0.0.1:20001".to_owned()));
        assert_eq!(text("udp:0"), Ok("udp:127.0.0.1:0".to_owned()));
        assert_eq!(
            text("udp:0.0.0.0:20001"),
            Ok("udp:0.0.0.0:20001".to_owned())
        );
        assert_eq!(text("tcp:[::1]:4000"), Ok("tcp:[::1]:4000".to_owned()));
    }

    #[test]
    fn wrong_addresses_are_refused() {
        use GatewayAddressError::{Address, LastPort, Protocol};
        let wrong = [
            ("20001", Protocol),
            ("http:80", Protocol),
            ("tcp:", Address),
            ("tcp:gateway:20001", Address),
            ("udp:70000", Address),
            ("tcp:65535", LastPort),
        ];
        for (text, why) in wrong {
            assert_eq!(text.parse::<GatewayAddress>(), Err(why), "{text}");
        }
    }
}
