//! How programs on this computer take part in a run.

use std::io;

use robot_plant::{
    time::Ps,
    world::{CanBusId, World},
};

use crate::{
    can_port::CanPort,
    gateway::{self, GatewayAddress},
    pty::{LinkPort, SlcanPort},
};

/// The ways that are offered to programs.
#[derive(Clone, Debug, Default)]
pub struct PcAccess {
    /// Buses that are LAWICEL adapters on pseudo-terminals.
    pub can_on_pty: Vec<CanBusId>,
    /// Both buses behind a CAN-to-Ethernet gateway.
    pub gateway: Option<GatewayAddress>,
    /// The PC link on a pseudo-terminal.
    pub link_on_pty: bool,
    /// The board waits for the answer of the program at the PC link to each state.
    pub lockstep: bool,
}

#[derive(Debug, thiserror::Error)]
pub enum PcError {
    #[error("cannot open a pseudo-terminal: {0}")]
    Terminal(io::Error),
    #[error("cannot open a gateway at {at}: {why}; port 0 takes any that is free")]
    Gateway { at: GatewayAddress, why: io::Error },
    #[error(
        "a bus has one adapter: leave out either the gateway, which takes both buses, or the pseudo-terminal"
    )]
    TwoAdapters,
}

impl PcAccess {
    pub fn is_offered(&self) -> bool {
        !self.can_on_pty.is_empty() || self.gateway.is_some() || self.link_on_pty
    }

    pub(crate) fn open(&self) -> Result<PcPorts, PcError> {
        let mut ports = PcPorts::default();
        for bus in &self.can_on_pty {
            let port = SlcanPort::open(*bus).map_err(PcError::Terminal)?;
            ports.can.push(Box::new(port));
        }
        if let Some(at) = self.gateway {
            if !ports.can.is_empty() {
                return Err(PcError::TwoAdapters);
            }
            let both = gateway::open(at).map_err(|why| PcError::Gateway { at, why })?;
            ports.can.extend(both.map(|port| Box::new(port) as _));
        }
        if self.link_on_pty {
            ports.link = Some(LinkPort::open(self.lockstep).map_err(PcError::Terminal)?);
        }
        Ok(ports)
    }
}

/// The opened ways.
#[derive(Default)]
pub struct PcPorts {
    pub can: Vec<Box<dyn CanPort>>,
    pub link: Option<LinkPort>,
}

impl PcPorts {
    pub fn is_empty(&self) -> bool {
        self.can.is_empty() && self.link.is_none()
    }

    /// Serves all programs. It waits for none, except for one in lockstep.
    pub fn serve(&mut self, world: &mut World, now: Ps) -> io::Result<()> {
        self.can.iter_mut().try_for_each(|port| port.serve(world))?;
        self.link
            .iter_mut()
            .try_for_each(|port| port.serve(world, now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bus_has_one_adapter() {
        let both = PcAccess {
            can_on_pty: vec![CanBusId::Can1],
            gateway: Some("tcp:0".parse().expect("an address")),
            ..PcAccess::default()
        };
        assert!(matches!(both.open(), Err(PcError::TwoAdapters)));
    }
}
