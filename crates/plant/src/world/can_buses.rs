//! Who sits on the CAN buses. The bus model asks every node at each start of frame; nodes are numbered from 0 on each
//! bus.

use super::{CanBusId, WireEvent, World, signals};
use crate::{faults::Fault, time::Ps, wire::CanFrame};

/// The highest priority there is.
const ROGUE_FRAME: CanFrame = CanFrame {
    id: 0,
    extended: false,
    dlc: 8,
    data: [0; 8],
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Node {
    /// Wheel controller.
    Esc(usize),
    /// Bus adapter of a PC: acknowledges, never sends.
    Listener,
    Rogue(Fault),
}

const CAN1: &[Node] = &[
    Node::Esc(0),
    Node::Esc(1),
    Node::Rogue(Fault::RogueNodeCan1),
];
const CAN2: &[Node] = &[Node::Listener, Node::Rogue(Fault::RogueNodeCan2)];

fn nodes(bus: CanBusId) -> &'static [Node] {
    match bus {
        CanBusId::Can1 => CAN1,
        CanBusId::Can2 => CAN2,
    }
}

impl World {
    pub fn can_nodes(&self, bus: CanBusId) -> usize {
        nodes(bus).len()
    }

    /// A node that is unpowered or unplugged neither sends nor acknowledges.
    pub fn can_present(&self, bus: CanBusId, node: usize) -> bool {
        let unplugged = match bus {
            CanBusId::Can1 => self.faults.has(Fault::Can1Empty),
            CanBusId::Can2 => self.faults.has(Fault::Can2Empty),
        };
        !unplugged
            && match nodes(bus)[node] {
                Node::Esc(wheel) => self.escs[wheel].powered(),
                Node::Listener => true,
                Node::Rogue(fault) => self.faults.has(fault),
            }
    }

    /// The frame this node wants on the bus now.
    pub fn can_pending(&self, bus: CanBusId, node: usize, _now: Ps) -> Option<CanFrame> {
        if !self.can_present(bus, node) {
            return None;
        }
        match nodes(bus)[node] {
            Node::Esc(wheel) => self.escs[wheel].pending(),
            Node::Listener => None,
            Node::Rogue(_) => Some(ROGUE_FRAME),
        }
    }

    /// Its pending frame went out and was acknowledged.
    pub fn can_sent(&mut self, bus: CanBusId, node: usize, now: Ps) {
        self.advance(now);
        if let Node::Esc(wheel) = nodes(bus)[node] {
            self.escs[wheel].sent();
            self.wire_events.push(WireEvent {
                at: now,
                signal: signals::motor_rpm(wheel),
                value: self.escs[wheel].fed_back_rpm(),
            });
        }
    }

    /// A frame of another node ended without error (called once for each present node but the sender).
    pub fn can_received(&mut self, bus: CanBusId, node: usize, frame: &CanFrame, now: Ps) {
        self.advance(now);
        if let Node::Esc(wheel) = nodes(bus)[node]
            && self.escs[wheel].receive(frame)
        {
            self.wire_events.push(WireEvent {
                at: now,
                signal: signals::motor_current_ma(wheel),
                value: self.escs[wheel].commanded_ma(),
            });
        }
    }

    /// True while a fault cuts or shorts this bus for everybody.
    pub fn can_broken(&self, bus: CanBusId) -> bool {
        self.faults.has(match bus {
            CanBusId::Can1 => Fault::Can1Broken,
            CanBusId::Can2 => Fault::Can2Broken,
        })
    }
}
