//! The PC on the robot's serial link: its program, and the cable with its faults.
//!
//! The codec is written from docs/pc-link.md, not taken from the firmware.

mod codec;
mod faults;
mod line;
mod line_noise;
mod meter;
mod program;
mod scanner;

use crate::{
    random::{Random, Stream},
    serial_adapter::LINK_FORMAT,
    time::{MS, Ps},
    wire::{LineEvent, UartChar},
};
use codec::{DOWN_LEN, UP_LEN};
pub(crate) use codec::{Downlink, Uplink};
pub(crate) use faults::LinkFaults;
use line::Line;
use line_noise::LineNoise;
pub(crate) use meter::Meter;
use program::Program;
pub use program::{PcDrive, PcInput, PcJoints};
use scanner::Scanner;

/// Frames of the serial link, for whoever watches its bytes.
pub mod link_frames {
    pub use super::{
        codec::{DOWN_LEN, UP_LEN},
        scanner::Scanner,
    };
}

/// A flood is made in pieces of this length.
const FLOOD_PIECE: Ps = MS;
/// A line that is held low rises for an instant after this time.
const HELD_LOW: Ps = 50 * MS;
/// Share of the frames that a noisy line precedes with a stray byte.
const STRAY: f64 = 0.3;

/// The program at the far end of the cable, both lines, and what is heard at their ends.
#[derive(Clone)]
pub(crate) struct Pc {
    program: Program,
    to_board: Line,
    down: Scanner<DOWN_LEN>,
    up: Scanner<UP_LEN>,
    noise_down: LineNoise,
    noise_up: LineNoise,
    garbage: Random,
    next_disturbance: Ps,
    /// The last frame that was whole at the board, and the number of them.
    pub(crate) asked: Downlink,
    pub(crate) down_frames: u64,
    /// The last frame that was whole at the PC.
    pub(crate) told: Option<Uplink>,
    pub(crate) meter: Meter,
    /// Characters from the board that the PC's adapter could not read: another rate or format, or no stop bit.
    pub(crate) unreadable: u64,
}

impl Pc {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            program: Program::new(Random::new(seed, Stream::PcExtremes)),
            to_board: Line::default(),
            down: Scanner::default(),
            up: Scanner::default(),
            noise_down: LineNoise::new(Random::new(seed, Stream::LinkDown)),
            noise_up: LineNoise::new(Random::new(seed, Stream::LinkUp)),
            garbage: Random::new(seed, Stream::LinkFlood),
            next_disturbance: Ps::MAX,
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

    /// Whether its cable is plugged into the board. It is from the first start of the program on.
    pub(crate) fn plugged(&self) -> bool {
        self.program.started()
    }

    /// Frames from the board with a wrong checksum, and bytes of it that belonged to no frame.
    pub(crate) fn up_errors(&self) -> [u64; 2] {
        [self.up.crc_errors, self.up.discarded]
    }

    /// Number of frames that the program has sent.
    pub(crate) fn sent(&self) -> u64 {
        self.program.sent()
    }

    /// When the program or a fault puts something on the line next.
    pub(crate) fn next_due(&self) -> Ps {
        self.program.next_frame().min(self.next_disturbance)
    }

    /// Start of the next character to the board after `now`, or else when the next is put on the line.
    pub(crate) fn next_event(&self, now: Ps) -> Ps {
        self.to_board.next_start(now).min(self.next_due())
    }

    /// A fault of the line begins or ends at `now`.
    pub(crate) fn set_faults(&mut self, faults: LinkFaults, now: Ps) {
        if !faults.lets_through() {
            self.to_board.drop_unstarted(now);
        }
        let disturbed = !faults.cut_down && (faults.flood || faults.held_low);
        self.next_disturbance = match (disturbed, self.next_disturbance) {
            (false, _) => Ps::MAX,
            (true, Ps::MAX) => now,
            (true, running) => running,
        };
    }

    /// Puts on the line what is due at [`Self::next_due`].
    pub(crate) fn act(&mut self, faults: LinkFaults) {
        let at = self.next_due();
        if self.next_disturbance == at {
            self.disturb(at, faults);
            return;
        }
        let frame = self.program.frame(faults, self.told.as_ref());
        if faults.noise && self.garbage.unit() < STRAY {
            let stray = self.garbage.byte();
            self.send(stray, at, faults);
        }
        for byte in frame {
            self.send(byte, at, faults);
        }
    }

    fn disturb(&mut self, at: Ps, faults: LinkFaults) {
        if faults.held_low {
            self.next_disturbance = at + HELD_LOW;
            self.to_board.hold_low(at, self.next_disturbance);
            return;
        }
        self.next_disturbance = at + FLOOD_PIECE;
        while self.to_board.free_from(at) < self.next_disturbance {
            let character = self.to_board.next_character(self.garbage.byte(), at);
            self.to_board.put(LineEvent::Character(character));
        }
    }

    fn send(&mut self, byte: u8, now: Ps, faults: LinkFaults) {
        if faults.lets_through() {
            let character = self.to_board.next_character(byte, now);
            self.pass(character, faults);
        }
    }

    /// Passes a character from the PC's end of the line to the board's.
    pub(crate) fn pass(&mut self, character: UartChar, faults: LinkFaults) {
        let arrives = if !faults.lets_through() {
            None
        } else if faults.noise {
            self.noise_down.disturb(character)
        } else {
            Some(LineEvent::Character(character))
        };
        if let Some(event) = arrives {
            self.to_board.put(event);
        }
    }

    /// Takes what is next on the line to the board, if it begins at or before `now`.
    pub(crate) fn next_on_the_line(&mut self, now: Ps) -> Option<LineEvent> {
        self.to_board.take(now)
    }

    /// Looks for a frame to the board whose last stop bit has ended by `now`. Returns the time of that.
    pub(crate) fn next_whole(&mut self, now: Ps) -> Option<Ps> {
        while let Some((at, byte)) = self.to_board.next_ended(now) {
            if let Some(frame) = self.down.take(byte) {
                self.asked = Downlink::decode(&frame);
                self.down_frames += 1;
                return Some(at);
            }
        }
        None
    }

    /// A character of the board as it arrives at the PC's adapter, if it does.
    pub(crate) fn arrives(&mut self, sent: UartChar, faults: LinkFaults) -> Option<UartChar> {
        if faults.cut_up {
            return None;
        }
        let heard = if faults.noise {
            self.noise_up.disturb(sent)?
        } else {
            LineEvent::Character(sent)
        };
        match heard {
            LineEvent::Character(heard) if LINK_FORMAT.understands(heard.format) => Some(heard),
            LineEvent::Character(_) | LineEvent::Low { .. } => {
                self.unreadable += 1;
                None
            }
        }
    }

    /// The program takes a character that ended `now`. Returns whether a frame is whole with it.
    pub(crate) fn receive(&mut self, heard: UartChar, now: Ps) -> bool {
        let Some(frame) = self.up.take(heard.byte) else {
            return false;
        };
        self.told = Some(Uplink::decode(&frame));
        self.meter.frame(now);
        true
    }
}

#[cfg(test)]
mod tests;
