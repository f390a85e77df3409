//! Both CAN buses with the time that frames take: arbitration among the board and the nodes, no errors.

use robot_app::domain::{BusId, CanFrame, StandardId};
use robot_plant::{
    time::{Ps, US},
    wire,
    world::{CanBusId, World},
};

const BIT: Ps = US;
/// Frame of 8 bytes with 8 stuff bits, the usual number, and the intermission. Shorter ones have 8 bits less a byte.
const BITS_AROUND_DATA: Ps = 47 + 8;

/// A frame on its way.
#[derive(Clone)]
struct Transmission {
    frame: wire::CanFrame,
    /// `None` for the board.
    node: Option<usize>,
    ends: Ps,
}

#[derive(Clone)]
struct Bus {
    id: CanBusId,
    /// Frames in the board's mailboxes, with the time from which they may be sent.
    waiting: Vec<(wire::CanFrame, Ps)>,
    on_the_wire: Option<Transmission>,
    /// What the board has received since its last tick.
    received: Vec<(CanFrame, Ps)>,
}

/// CAN1 and CAN2.
#[derive(Clone)]
pub(crate) struct Buses([Bus; 2]);

impl Buses {
    pub fn new() -> Self {
        Self(BusId::ALL.map(|bus| Bus {
            id: wire_of(bus),
            waiting: Vec::new(),
            on_the_wire: None,
            received: Vec::new(),
        }))
    }

    /// Puts a frame of the board into a mailbox, where it is at the time `from`.
    pub fn send(&mut self, bus: BusId, frame: &CanFrame, from: Ps) {
        let sent = wire::CanFrame {
            dlc: frame.payload().len() as u8,
            ..wire::CanFrame::with_data(frame.id().raw().into(), frame.padded_payload())
        };
        self.0[bus as usize].waiting.push((sent, from));
    }

    /// Drops the frames that still wait for their bus.
    pub fn drop_waiting(&mut self) {
        for bus in &mut self.0 {
            bus.waiting.clear();
        }
    }

    /// Passes on the frames received since the last call, with the times of their ends.
    pub fn take_received(&mut self, mut board: impl FnMut(BusId, &CanFrame, Ps)) {
        for (bus, id) in self.0.iter_mut().zip(BusId::ALL) {
            for (frame, at) in bus.received.drain(..) {
                board(id, &frame, at);
            }
        }
    }

    /// Lets the world and the buses run from `now` to `until`.
    pub fn run(&mut self, world: &mut World, mut now: Ps, until: Ps) {
        loop {
            let mut next = until;
            let mut idle = false;
            for bus in &mut self.0 {
                bus.start_if_idle(world, now);
                match &bus.on_the_wire {
                    Some(transmission) => next = next.min(transmission.ends),
                    None => {
                        idle = true;
                        next = next.min(bus.next_in_mailbox(now));
                    }
                }
            }
            if idle {
                next = next.min(world.next_can_event());
            }
            now = next.max(now);
            world.advance(now);
            let mut ended = false;
            for bus in &mut self.0 {
                ended |= bus.end_if_due(world, now);
            }
            if now >= until && !ended {
                return;
            }
        }
    }
}

impl Bus {
    /// When the next frame reaches a mailbox after `now`.
    fn next_in_mailbox(&self, now: Ps) -> Ps {
        let later = self.waiting.iter().map(|(_, from)| *from);
        later.filter(|from| *from > now).min().unwrap_or(Ps::MAX)
    }

    fn start_if_idle(&mut self, world: &World, now: Ps) {
        if self.on_the_wire.is_some() {
            return;
        }
        let ready = (0..self.waiting.len()).filter(|index| self.waiting[*index].1 <= now);
        let board = ready.min_by_key(|index| self.waiting[*index].0.id);
        let mut best = board.map(|index| (None, self.waiting[index].0));
        for node in 0..world.can_nodes(self.id) {
            if let Some(frame) = world.can_pending(self.id, node, now)
                && best.is_none_or(|(_, rival)| frame.id < rival.id)
            {
                best = Some((Some(node), frame));
            }
        }
        let Some((node, frame)) = best else { return };
        if let (None, Some(index)) = (node, board) {
            self.waiting.remove(index);
        }
        self.on_the_wire = Some(Transmission {
            frame,
            node,
            ends: now + (BITS_AROUND_DATA + 8 * Ps::from(frame.dlc)) * BIT,
        });
    }

    fn end_if_due(&mut self, world: &mut World, now: Ps) -> bool {
        let Some(Transmission { frame, node, .. }) = self
            .on_the_wire
            .take_if(|transmission| transmission.ends <= now)
        else {
            return false;
        };
        let Some(sender) = node else {
            for node in 0..world.can_nodes(self.id) {
                if world.can_present(self.id, node) {
                    world.can_received(self.id, node, &frame, now);
                }
            }
            return true;
        };
        world.can_sent(self.id, sender, now);
        let id = u16::try_from(frame.id).ok().and_then(StandardId::new);
        let payload = &frame.data[..frame.dlc.into()];
        let heard = id.and_then(|id| CanFrame::from_payload(id, payload));
        self.received.extend(heard.map(|frame| (frame, now)));
        true
    }
}

fn wire_of(bus: BusId) -> CanBusId {
    match bus {
        BusId::Can1 => CanBusId::Can1,
        BusId::Can2 => CanBusId::Can2,
    }
}
