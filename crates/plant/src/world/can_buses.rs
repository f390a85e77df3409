//! The nodes on the CAN buses, numbered from 0 on each bus. The bus model asks every node at each start of frame.

use robot_description::{Bus, Robot};

use super::{WireEvent, World, signals};
use crate::{
    can_adapter::{AdapterMode, CanAdapter},
    faults::Fault,
    joints::JOINTS,
    time::Ps,
    wire::{CanBusId, CanFrame},
};

/// Identifier 0 has the highest priority.
const ROGUE_FRAME: CanFrame = CanFrame::with_data(0, [0; 8]);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Node {
    /// Wheel controller.
    Esc(usize),
    /// Motor of a leg joint.
    Joint(usize),
    /// Bus adapter of a PC.
    Adapter,
    Rogue(Fault),
}

/// The nodes of CAN1 and CAN2: the motors that the robot's file puts there, a rogue one and a PC's adapter.
pub(super) fn nodes(robot: &Robot) -> [Vec<Node>; 2] {
    let buses = [
        (Bus::Can1, Fault::RogueNodeCan1),
        (Bus::Can2, Fault::RogueNodeCan2),
    ];
    buses.map(|(bus, rogue)| {
        let mut nodes = Vec::new();
        if robot.wheels.bus == bus {
            nodes.extend([Node::Esc(0), Node::Esc(1)]);
        }
        if robot.joints.bus == bus {
            nodes.extend((0..JOINTS).map(Node::Joint));
        }
        nodes.extend([Node::Rogue(rogue), Node::Adapter]);
        nodes
    })
}

impl World {
    /// Number of nodes on this bus, present or not, without the board.
    pub fn can_nodes(&self, bus: CanBusId) -> usize {
        self.nodes[bus as usize].len()
    }

    fn unplugged(&self, bus: CanBusId) -> bool {
        self.faults.has(match bus {
            CanBusId::Can1 => Fault::Can1Empty,
            CanBusId::Can2 => Fault::Can2Empty,
        })
    }

    /// False for a node without power or unplugged, which neither sends nor acknowledges.
    pub fn can_present(&self, bus: CanBusId, node: usize) -> bool {
        !self.unplugged(bus)
            && match self.nodes[bus as usize][node] {
                Node::Esc(wheel) => self.escs[wheel].powered(),
                Node::Joint(joint) => self.joints[joint].powered(),
                Node::Adapter => self.adapter(bus).mode() == AdapterMode::Active,
                Node::Rogue(fault) => self.faults.has(fault),
            }
    }

    /// True for every node that receives: the present ones and an adapter that only listens.
    pub fn can_hears(&self, bus: CanBusId, node: usize) -> bool {
        let listens = self.nodes[bus as usize][node] == Node::Adapter
            && self.adapter(bus).mode() == AdapterMode::ListenOnly;
        self.can_present(bus, node) || listens && !self.unplugged(bus)
    }

    fn adapter(&self, bus: CanBusId) -> &CanAdapter {
        &self.adapters[bus as usize]
    }

    /// The adapter through which a PC takes part in this bus.
    pub fn can_adapter(&mut self, bus: CanBusId) -> &mut CanAdapter {
        &mut self.adapters[bus as usize]
    }

    /// The frame that this node wants to send now.
    pub fn can_pending(&self, bus: CanBusId, node: usize, now: Ps) -> Option<CanFrame> {
        if !self.can_present(bus, node) {
            return None;
        }
        match self.nodes[bus as usize][node] {
            Node::Esc(wheel) => self.escs[wheel].pending(),
            Node::Joint(joint) => self.joints[joint].pending(now),
            Node::Adapter => self.adapter(bus).pending(),
            Node::Rogue(_) => Some(ROGUE_FRAME),
        }
    }

    /// Tells the node that its pending frame was sent and acknowledged.
    pub fn can_sent(&mut self, bus: CanBusId, node: usize, now: Ps) {
        self.advance(now);
        match self.nodes[bus as usize][node] {
            Node::Esc(wheel) => {
                self.escs[wheel].sent();
                self.wire_events.push(WireEvent {
                    at: now,
                    signal: signals::motor_rpm(wheel),
                    value: self.escs[wheel].fed_back_rpm(),
                });
            }
            Node::Adapter => self.can_adapter(bus).delivered(),
            Node::Joint(joint) => self.joint_sent(joint, now),
            Node::Rogue(_) => {}
        }
    }

    /// Delivers a frame that ended without error. To be called once for each node that receives, except the sender.
    pub fn can_received(&mut self, bus: CanBusId, node: usize, frame: &CanFrame, now: Ps) {
        self.advance(now);
        match self.nodes[bus as usize][node] {
            Node::Adapter => {
                self.record_tuning_reply(frame, now);
                self.can_adapter(bus).receive(frame, now);
            }
            Node::Rogue(_) => {}
            motor if self.variation.delay == 0 => self.motor_received(motor, frame, now),
            motor => {
                let heard = now + self.variation.delay;
                self.late.push_back((heard, motor, *frame));
            }
        }
    }

    /// When the next command that the variation delays reaches its motor.
    pub(super) fn next_late(&self) -> Ps {
        self.late.front().map_or(Ps::MAX, |(heard, ..)| *heard)
    }

    /// Lets the first delayed command reach its motor.
    pub(super) fn hear_late(&mut self) {
        if let Some((heard, motor, frame)) = self.late.pop_front() {
            self.motor_received(motor, &frame, heard);
        }
    }

    fn motor_received(&mut self, motor: Node, frame: &CanFrame, now: Ps) {
        match motor {
            Node::Esc(wheel) if self.escs[wheel].receive(frame) => {
                self.wire_events.push(WireEvent {
                    at: now,
                    signal: signals::motor_current_ma(wheel),
                    value: self.escs[wheel].commanded_ma(),
                });
            }
            Node::Joint(joint) => self.joint_received(joint, frame, now),
            Node::Esc(_) | Node::Adapter | Node::Rogue(_) => {}
        }
    }

    fn record_tuning_reply(&mut self, frame: &CanFrame, at: Ps) {
        if !self.tuning_replies.record(frame) {
            return;
        }
        let count = (signals::TUNING_REPLIES, self.tuning_replies.count as f64);
        let bytes = self.tuning_replies.last.iter().enumerate();
        let bytes = bytes.map(|(index, value)| (signals::tuning_reply(index), *value));
        let events = [count].into_iter().chain(bytes);
        self.wire_events
            .extend(events.map(|(signal, value)| WireEvent { at, signal, value }));
    }

    /// True while a fault cuts or shorts this bus for all nodes.
    pub fn can_broken(&self, bus: CanBusId) -> bool {
        self.faults.has(match bus {
            CanBusId::Can1 => Fault::Can1Broken,
            CanBusId::Can2 => Fault::Can2Broken,
        })
    }
}
