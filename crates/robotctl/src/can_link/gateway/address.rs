//! Where a gateway is, and what is wrong if it is not.

use std::{
    fmt,
    io::{self, ErrorKind},
    net::{IpAddr, SocketAddr, ToSocketAddrs},
};

use super::super::CanLinkError;

/// One CAN port of a gateway: `tcp:192.168.0.7:20001`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GatewayAddress {
    pub(super) protocol: Protocol,
    /// Host and port with a colon between.
    place: String,
}

/// How the port of the gateway is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    Tcp,
    Udp,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` names no gateway: write {example}, with its address and port (20001 is usually CAN1, 20002 CAN2)"
)]
pub struct GatewayAddressError {
    text: String,
    example: String,
}

impl GatewayAddress {
    /// Returns `None` for text that does not look like the address of a gateway. An address without `tcp:` or `udp:` is
    /// an error.
    pub fn parse(text: &str) -> Option<Result<Self, GatewayAddressError>> {
        let wrong = |example: String| {
            let text = text.to_owned();
            Some(Err(GatewayAddressError { text, example }))
        };
        let (protocol, place) = match text.split_once(':') {
            Some(("tcp", place)) => (Protocol::Tcp, place),
            Some(("udp", place)) => (Protocol::Udp, place),
            _ if is_place(text) => return wrong(format!("tcp:{text} or udp:{text}")),
            _ if text.parse::<IpAddr>().is_ok() => {
                return wrong(format!("tcp:{text}:20001 or udp:{text}:20001"));
            }
            _ => return None,
        };
        if !is_place(place) {
            return wrong(format!("{protocol}:192.168.0.7:20001"));
        }
        Some(Ok(Self {
            protocol,
            place: place.to_owned(),
        }))
    }

    pub fn resolve(&self) -> io::Result<Vec<SocketAddr>> {
        Ok(self.place.to_socket_addrs()?.collect())
    }

    /// Names the gateway and the likely cause of an error.
    pub fn failed(&self, error: &io::Error) -> CanLinkError {
        CanLinkError::Gateway {
            device: self.to_string(),
            why: format!("{error}; {}", self.advice(error.kind())),
        }
    }

    /// Says what to do about an error.
    fn advice(&self, error: ErrorKind) -> &'static str {
        match (error, self.protocol) {
            (ErrorKind::ConnectionRefused, Protocol::Tcp) => {
                "nothing listens there: is this CAN port of the gateway set to TCP server, not UDP, and is the port right? \
                 (usually 20001 for CAN1, 20002 for CAN2)"
            }
            (ErrorKind::ConnectionRefused | ErrorKind::ConnectionReset, Protocol::Udp) => {
                "nothing listens there: is this CAN port of the gateway set to UDP, not TCP server, and is the port right? \
                 (usually 20001 for CAN1, 20002 for CAN2)"
            }
            (
                ErrorKind::ConnectionReset
                | ErrorKind::ConnectionAborted
                | ErrorKind::BrokenPipe
                | ErrorKind::UnexpectedEof,
                Protocol::Tcp,
            ) => {
                "the gateway has closed the connection: it serves few programs at once (close others), and settings take \
                 effect with a restart"
            }
            _ => {
                "is the gateway on and plugged in, is its address right, and is this computer in the same network? (a \
                 Waveshare at 192.168.0.7 needs a computer at 192.168.0.x)"
            }
        }
    }

    /// Says what may be wrong when the gateway takes frames and the robot does not answer.
    pub fn why_silent(&self) -> String {
        let about_udp = match self.protocol {
            Protocol::Tcp => "",
            Protocol::Udp => {
                ", does the gateway answer to a ping, is its port set to UDP and not to TCP server"
            }
        };
        format!(
            "is it on{about_udp}, is {} the port of that bus (usually 20001 for CAN1, 20002 for CAN2), is this CAN port of \
             the gateway set to 1 Mbit/s, and is the bus terminated?",
            self.place
        )
    }
}

/// True for a host and a port with a colon between. Names of serial ports may have colons too.
fn is_place(text: &str) -> bool {
    text.rsplit_once(':').is_some_and(|(host, port)| {
        !host.is_empty()
            && !host.contains(['/', '\\'])
            && port.parse::<u16>().is_ok_and(|port| port != 0)
    })
}

impl fmt::Display for GatewayAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.protocol, self.place)
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tcp => "tcp",
            Self::Udp => "udp",
        })
    }
}
