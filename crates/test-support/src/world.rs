//! The wires between the app and the simulated world.

use robot_app::domain::{BusId, CanFrame, StandardId};
use robot_plant::{
    time::Ps,
    wire,
    world::{CanBusId, World},
};

/// Both CAN buses without their timing: every frame that waits is delivered at once.
pub trait CanWires {
    /// Passes each frame that a motor wants to send to `board`.
    fn take_frames(&mut self, now: Ps, board: impl FnMut(BusId, &CanFrame));

    /// Delivers a frame of the board to every node that is present.
    fn deliver(&mut self, bus: BusId, frame: &CanFrame, now: Ps);
}

impl CanWires for World {
    fn take_frames(&mut self, now: Ps, mut board: impl FnMut(BusId, &CanFrame)) {
        for bus in BusId::ALL {
            let wire = wire_of(bus);
            for node in 0..self.can_nodes(wire) {
                if let Some(frame) = self.can_pending(wire, node, now) {
                    self.can_sent(wire, node, now);
                    let id = StandardId::new(frame.id as u16).expect("11 bits");
                    let frame = CanFrame::from_payload(id, &frame.data[..frame.dlc.into()]);
                    board(bus, &frame.expect("at most eight bytes"));
                }
            }
        }
    }

    fn deliver(&mut self, bus: BusId, frame: &CanFrame, now: Ps) {
        let wire = wire_of(bus);
        let sent = wire::CanFrame {
            dlc: frame.payload().len() as u8,
            ..wire::CanFrame::with_data(frame.id().raw().into(), frame.padded_payload())
        };
        for node in 0..self.can_nodes(wire) {
            if self.can_present(wire, node) {
                self.can_received(wire, node, &sent, now);
            }
        }
    }
}

fn wire_of(bus: BusId) -> CanBusId {
    match bus {
        BusId::Can1 => CanBusId::Can1,
        BusId::Can2 => CanBusId::Can2,
    }
}
