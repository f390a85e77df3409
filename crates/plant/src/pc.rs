//! The PC on the robot's serial link: its program, its adapter for programs outside of the simulation, and the cable.
//!
//! The codec is written from docs/pc-link.md, not taken from the firmware.

mod adapter;
mod codec;
mod faults;
mod line;
mod line_noise;
mod meter;
mod program;
mod scanner;

use crate::{
    random::{Random, Stream},
    time::{MS, Ps},
    wire::UartChar,
};
pub use adapter::SerialAdapter;
use codec::{DOWN_LEN, UP_LEN};
pub(crate) use codec::{Downlink, Uplink};
pub(crate) use faults::LinkFaults;
use line::Line;
use line_noise::LineNoise;
pub(crate) use meter::Meter;
use program::Program;
pub use program::{PcInput, PcJoints};
use scanner::Scanner;

/// A flood is made in pieces of this length.
const FLOOD_PIECE: Ps = MS;
/// Share of the frames that a noisy line precedes with a stray byte.
const STRAY: f64 = 0.3;

/// Both directions of the cable and what is at its far end.
pub(crate) struct Pc {
    program: Program,
    adapter: SerialAdapter,
    to_board: Line,
    down: Scanner<DOWN_LEN>,
    up: Scanner<UP_LEN>,
    noise_down: LineNoise,
    noise_up: LineNoise,
    garbage: Random,
    next_flood: Ps,
    /// The last frame that was whole at the board, and the number of them.
    pub(crate) asked: Downlink,
    pub(crate) down_frames: u64,
    /// The last frame that was whole at the PC.
    pub(crate) told: Option<Uplink>,
    pub(crate) meter: Meter,
    /// Characters from the board that the PC's adapter could not read: another rate or another format.
    pub(crate) unreadable: u64,
}

impl Pc {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            program: Program::new(Random::new(seed, Stream::PcExtremes)),
            adapter: SerialAdapter::default(),
            to_board: Line::default(),
            down: Scanner::default(),
            up: Scanner::default(),
            noise_down: LineNoise::new(Random::new(seed, Stream::LinkDown)),
            noise_up: LineNoise::new(Random::new(seed, Stream::LinkUp)),
            garbage: Random::new(seed, Stream::LinkFlood),
            next_flood: Ps::MAX,
            asked: Downlink::default(),
            down_frames: 0,
            told: None,
            meter: Meter::default(),
            unreadable: 0,
        }
    }

    /// Changes what the PC's program sends from `now` on.
    pub(crate) fn set(&mut self, input: PcInput, now: Ps) {
        self.program.set(input, self.told.as_ref(), now);
    }

    pub(crate) fn adapter(&mut self) -> &mut SerialAdapter {
        &mut self.adapter
    }

    /// Frames from the board with a wrong checksum, and bytes of it that belonged to no frame.
    pub(crate) fn up_errors(&self) -> [u64; 2] {
        [self.up.crc_errors, self.up.discarded]
    }

    /// Number of frames that the program has sent.
    pub(crate) fn sent(&self) -> u64 {
        self.program.sent()
    }

    /// When the program or a flood puts something on the line next.
    pub(crate) fn next_due(&self) -> Ps {
        self.program.next_frame().min(self.next_flood)
    }

    /// Start of the first character to the board after `now`, or else when the next is put on the line.
    pub(crate) fn next_event(&self, now: Ps) -> Ps {
        self.to_board.next_start(now).min(self.next_due())
    }

    /// A fault of the line begins or ends at `now`.
    pub(crate) fn set_faults(&mut self, faults: LinkFaults, now: Ps) {
        if faults.cut_down || faults.flood {
            self.to_board.drop_unstarted(now);
        }
        let flooding = faults.flood && !faults.cut_down;
        self.next_flood = match (flooding, self.next_flood) {
            (false, _) => Ps::MAX,
            (true, Ps::MAX) => now,
            (true, running) => running,
        };
    }

    /// Puts on the line what is due at [`Self::next_due`].
    pub(crate) fn act(&mut self, faults: LinkFaults) {
        let at = self.next_due();
        if self.next_flood == at {
            self.next_flood = at + FLOOD_PIECE;
            while self.to_board.free_from(at) < self.next_flood {
                let byte = self.garbage.byte();
                self.to_board.send(byte, at);
            }
            return;
        }
        let frame = self.program.frame(faults, self.told.as_ref());
        if faults.noise && self.garbage.unit() < STRAY {
            let stray = self.garbage.byte();
            self.put(stray, at, faults);
        }
        for byte in frame {
            self.put(byte, at, faults);
        }
    }

    fn put(&mut self, byte: u8, now: Ps, faults: LinkFaults) {
        if faults.cut_down || faults.flood {
            return;
        }
        let noise = faults.noise.then_some(&mut self.noise_down);
        self.to_board.send_through(byte, now, noise);
    }

    /// Whether nothing is on its way to the board.
    pub(crate) fn is_idle(&self) -> bool {
        self.adapter.is_empty() && self.to_board.is_empty()
    }

    /// Sends what waits in the adapter, and looks for a frame to the board whose last stop bit has ended by `now`. Returns
    /// the time of that.
    pub(crate) fn advance(&mut self, now: Ps, faults: LinkFaults) -> Option<Ps> {
        while let Some(byte) = self.adapter.next_to_send() {
            self.put(byte, now, faults);
        }
        while let Some((at, byte)) = self.to_board.next_ended(now) {
            if let Some(frame) = self.down.take(byte) {
                self.asked = Downlink::decode(&frame);
                self.down_frames += 1;
                return Some(at);
            }
        }
        None
    }

    /// Takes the next character on the line to the board whose start bit begins at or before `now`.
    pub(crate) fn take(&mut self, now: Ps) -> Option<UartChar> {
        self.to_board.take(now)
    }

    /// A character of the board has ended. Returns the time if a frame is whole with it.
    pub(crate) fn receive(&mut self, sent: UartChar, faults: LinkFaults) -> Option<Ps> {
        if faults.cut_up {
            return None;
        }
        let heard = if faults.noise {
            self.noise_up.disturb(sent)?
        } else {
            sent
        };
        let at = heard.start + line::character_time(heard.format);
        if !line::readable(heard.format) {
            self.unreadable += 1;
            return None;
        }
        self.adapter.receive(heard.byte);
        let frame = self.up.take(heard.byte)?;
        self.told = Some(Uplink::decode(&frame));
        self.meter.frame(at);
        Some(at)
    }
}

#[cfg(test)]
mod tests;
