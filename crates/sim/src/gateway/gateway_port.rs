//! One CAN bus at one port of the gateway.

use std::{io, net::SocketAddr};

use robot_plant::{
    can_adapter::{AdapterMode, CanAdapter},
    world::{CanBusId, World},
};

use super::{
    frame::{self, LENGTH},
    tcp::TcpServer,
    udp::UdpServer,
};
use crate::can_port::{CanDevice, CanPort, PortStats, Protocol};

pub struct GatewayPort {
    bus: CanBusId,
    server: Server,
    device: CanDevice,
    stats: PortStats,
    /// Frames of the bus that clients did not get.
    lost: u64,
}

enum Server {
    Tcp(TcpServer),
    Udp(UdpServer),
}

impl GatewayPort {
    pub fn open(bus: CanBusId, protocol: Protocol, address: SocketAddr) -> io::Result<Self> {
        let (server, address) = match protocol {
            Protocol::Tcp => {
                let server = TcpServer::open(address)?;
                let address = server.address()?;
                (Server::Tcp(server), address)
            }
            Protocol::Udp => {
                let server = UdpServer::open(address)?;
                let address = server.address()?;
                (Server::Udp(server), address)
            }
        };
        Ok(Self {
            bus,
            server,
            device: CanDevice::Gateway(protocol, address),
            stats: PortStats::default(),
            lost: 0,
        })
    }

    pub(super) fn receive(&mut self, adapter: &mut CanAdapter) {
        let Self { server, stats, .. } = self;
        let mut malformed = 0;
        let mut take = |bytes: &[u8; LENGTH]| match frame::decode(bytes) {
            Some(frame) => stats.refused += u64::from(!adapter.send(frame)),
            None => malformed += 1,
        };
        match server {
            Server::Tcp(server) => server.receive(&mut take),
            Server::Udp(server) => {
                let cut = server.receive(&mut take);
                malformed += cut;
            }
        }
        stats.malformed += malformed;
        stats.from_pc = adapter.sent();
    }

    fn pass_on(&mut self, adapter: &mut CanAdapter) {
        let mut frames = Vec::new();
        while let Some((_, frame)) = adapter.take() {
            frames.extend(frame::encode(&frame));
        }
        let (taken, lost) = match &mut self.server {
            Server::Tcp(server) => server.send(&frames),
            Server::Udp(server) => server.send(&frames),
        };
        self.lost += lost;
        self.stats.to_pc += taken;
        self.stats.dropped = self.lost + adapter.lost();
    }
}

impl CanPort for GatewayPort {
    fn bus(&self) -> CanBusId {
        self.bus
    }

    fn device(&self) -> CanDevice {
        self.device.clone()
    }

    fn stats(&self) -> PortStats {
        self.stats
    }

    fn serve(&mut self, world: &mut World) -> io::Result<()> {
        let adapter = world.can_adapter(self.bus);
        // A gateway takes part in its buses from the moment it has power.
        if adapter.mode() != AdapterMode::Active {
            adapter.set_mode(AdapterMode::Active);
        }
        self.receive(adapter);
        self.pass_on(adapter);
        Ok(())
    }
}
