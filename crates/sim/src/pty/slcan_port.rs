//! One CAN bus on one pseudo-terminal.

use std::io;

use robot_plant::{
    can_adapter::CanAdapter,
    time::{MS, Ps},
    world::{CanBusId, World},
};
use robot_pseudo_terminal::Terminal;

use super::{
    frame_text,
    lawicel::{self, Lawicel, Request, flags},
};
use crate::can_port::{CanDevice, CanPort, PortStats};

/// Limit of text that waits for the PC, a quarter of a second at full bus load.
const WAITING: usize = 64 * 1024;
/// Bytes taken from the PC in one call, more than a bus carries in a millisecond.
const READ: u64 = 4 * 1024;
/// Time stamps run from 0 to 59,999.
const STAMP_MS: Ps = 60_000;

/// A LAWICEL adapter on a bus.
pub struct SlcanPort {
    bus: CanBusId,
    terminal: Terminal,
    lawicel: Lawicel,
    arrived: Vec<u8>,
    waiting: String,
    flags: u8,
    /// Number of frames dropped here and by the adapter.
    dropped: u64,
    stats: PortStats,
}

impl SlcanPort {
    pub fn open(bus: CanBusId) -> io::Result<Self> {
        Ok(Self {
            bus,
            terminal: Terminal::open()?,
            lawicel: Lawicel::default(),
            arrived: Vec::new(),
            waiting: String::new(),
            flags: 0,
            dropped: 0,
            stats: PortStats::default(),
        })
    }

    fn answer(&mut self, request: Request, adapter: &mut CanAdapter) {
        let reply = match request {
            Request::Answered(reply) => reply,
            Request::Switch(mode) => {
                adapter.set_mode(mode);
                self.flags = 0;
                lawicel::SWITCHED
            }
            Request::Send(frame) => {
                let taken = adapter.send(frame);
                if !taken {
                    self.flags |= flags::TRANSMIT_FULL;
                    self.stats.refused += 1;
                }
                lawicel::sent_reply(&frame, taken)
            }
            Request::Flags => &lawicel::flags_reply(std::mem::take(&mut self.flags)),
        };
        if self.waiting.len() < 2 * WAITING {
            self.waiting.push_str(reply);
        }
    }

    fn pass_on(&mut self, adapter: &mut CanAdapter) {
        while let Some((at, frame)) = adapter.take() {
            if self.waiting.len() >= WAITING {
                self.dropped += 1;
                continue;
            }
            let stamp = self
                .lawicel
                .time_stamps
                .then_some((at / MS % STAMP_MS) as u16);
            frame_text::append(&frame, stamp, &mut self.waiting);
            self.stats.to_pc += 1;
        }
        let dropped = self.dropped + adapter.lost();
        if dropped > self.stats.dropped {
            self.flags |= flags::RECEIVE_FULL;
        }
        self.stats.dropped = dropped;
        self.stats.from_pc = adapter.sent();
    }
}

impl CanPort for SlcanPort {
    fn bus(&self) -> CanBusId {
        self.bus
    }

    fn device(&self) -> CanDevice {
        CanDevice::Terminal(self.terminal.path().to_owned())
    }

    fn stats(&self) -> PortStats {
        self.stats
    }

    fn serve(&mut self, world: &mut World) -> io::Result<()> {
        let adapter = world.can_adapter(self.bus);
        self.terminal.read(&mut self.arrived, READ)?;
        for byte in std::mem::take(&mut self.arrived) {
            if let Some(request) = self.lawicel.feed(byte, adapter.mode()) {
                self.answer(request, adapter);
            }
        }
        self.pass_on(adapter);
        let written = self.terminal.write(self.waiting.as_bytes())?;
        self.waiting.drain(..written);
        Ok(())
    }
}
