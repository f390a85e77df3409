//! Both CAN buses behind a gateway to Ethernet, as a Waveshare 2-CH-CAN-TO-ETH passes them on: each frame as 13 bytes,
//! each bus at a port of its own.

mod address;
mod frame;
mod gateway_port;
mod tcp;
mod udp;

use std::io;

use robot_plant::world::CanBusId;

pub use address::{GatewayAddress, GatewayAddressError};
use gateway_port::GatewayPort;

/// Opens the ports of both buses.
pub(crate) fn open(at: GatewayAddress) -> io::Result<[GatewayPort; 2]> {
    let mut can2 = at.can1;
    if can2.port() != 0 {
        can2.set_port(can2.port() + 1);
    }
    Ok([
        GatewayPort::open(CanBusId::Can1, at.protocol, at.can1)?,
        GatewayPort::open(CanBusId::Can2, at.protocol, can2)?,
    ])
}

#[cfg(test)]
mod tests;
