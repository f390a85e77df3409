//! The LAWICEL command set of CAN232 and CANUSB adapters, which slcan tools speak: lines of ASCII that end with CR.
//!
//! Polling (A, P, X), dual filters (W), the serial line's own bit rate (U) and automatic start-up (Q) are not supported
//! and answered as unknown commands.

use robot_plant::{can_adapter::AdapterMode, wire::CanFrame};

use super::frame_text::{self, number};

const OK: &str = "\r";
/// BELL, the reply to a command that is unknown, malformed or impossible in this state.
const ERROR: &str = "\x07";
/// Bit rate of every emulated bus. An adapter with another bit rate would only destroy frames, so it does not open.
const BUS_BPS: u32 = 1_000_000;
/// Bit rates of the commands `S0` to `S8`.
const BIT_RATES_BPS: [u32; 9] = [
    10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, BUS_BPS,
];
/// Clock of the SJA1000, to which the bit timing registers in `s` refer.
const SJA1000_HZ: u32 = 16_000_000;
/// Longest line: an extended frame of eight bytes.
const LONGEST: usize = 1 + 8 + 1 + 16;

/// A request of the PC to the adapter. The reply depends on whether it can be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// A request whose reply is already known.
    Answered(&'static str),
    Switch(AdapterMode),
    Send(CanFrame),
    Flags,
}

/// The adapter's settings, and the line being received.
#[derive(Debug, Default)]
pub struct Lawicel {
    line: Vec<u8>,
    bit_rate_bps: Option<u32>,
    pub time_stamps: bool,
}

impl Lawicel {
    /// Takes one byte; a complete line gives a request. `mode` is the channel's present state.
    pub fn feed(&mut self, byte: u8, mode: AdapterMode) -> Option<Request> {
        match byte {
            b'\r' => {
                let line = std::mem::take(&mut self.line);
                Some(
                    self.command(&line, mode)
                        .unwrap_or(Request::Answered(ERROR)),
                )
            }
            b'\n' => None,
            _ => {
                // One byte too many is kept to mark a line that is too long.
                if self.line.len() <= LONGEST {
                    self.line.push(byte);
                }
                None
            }
        }
    }

    fn command(&mut self, line: &[u8], mode: AdapterMode) -> Option<Request> {
        let (letter, rest) = line.split_first()?;
        let closed = mode == AdapterMode::Off;
        match (letter, rest) {
            (b'S', [digit]) if closed => self.set_bit_rate(standard_rate(*digit)?),
            (b's', [btr0 @ .., _, _]) if closed && rest.len() == 4 => {
                self.set_bit_rate(register_rate(number(btr0)?, number(&rest[2..])?))
            }
            (b'O', []) if closed => self.open(AdapterMode::Active),
            (b'L', []) if closed => self.open(AdapterMode::ListenOnly),
            (b'C', []) if !closed => Some(Request::Switch(AdapterMode::Off)),
            (b't' | b'T' | b'r' | b'R', _) if mode == AdapterMode::Active => {
                frame_text::parse(line).map(Request::Send)
            }
            (b'F', []) if !closed => Some(Request::Flags),
            (b'Z', [digit @ (b'0' | b'1')]) if closed => {
                self.time_stamps = *digit == b'1';
                Some(Request::Answered(OK))
            }
            // The acceptance filter lets every frame pass. A mask that would not is refused.
            (b'M', code) if closed && code.len() == 8 => {
                number(code).map(|_| Request::Answered(OK))
            }
            (b'm', b"FFFFFFFF" | b"ffffffff") if closed => Some(Request::Answered(OK)),
            (b'V', []) => Some(Request::Answered("V0101\r")),
            (b'v', []) => Some(Request::Answered("v0101\r")),
            (b'N', []) => Some(Request::Answered("NEMU1\r")),
            _ => None,
        }
    }

    fn set_bit_rate(&mut self, bps: u32) -> Option<Request> {
        self.bit_rate_bps = Some(bps);
        Some(Request::Answered(OK))
    }

    fn open(&self, mode: AdapterMode) -> Option<Request> {
        (self.bit_rate_bps? == BUS_BPS).then_some(Request::Switch(mode))
    }
}

/// Reply to `O`, `L` and `C`.
pub const SWITCHED: &str = OK;

/// Reply to a frame, which is `z` or `Z` as the adapter need not be polled.
pub fn sent_reply(frame: &CanFrame, taken: bool) -> &'static str {
    match (taken, frame.extended) {
        (true, false) => "z\r",
        (true, true) => "Z\r",
        (false, _) => ERROR,
    }
}

/// Status bits of `F` that this adapter can raise.
pub mod flags {
    /// Received frames were lost because the PC did not read them.
    pub const RECEIVE_FULL: u8 = 1 << 0;
    /// A frame of the PC was refused because too many wait.
    pub const TRANSMIT_FULL: u8 = 1 << 1;
}

pub fn flags_reply(flags: u8) -> String {
    format!("F{flags:02X}\r")
}

fn standard_rate(digit: u8) -> Option<u32> {
    let place = digit.checked_sub(b'0')?;
    BIT_RATES_BPS.get(usize::from(place)).copied()
}

/// SJA1000: a bit is 1 + TSEG1 + 1 + TSEG2 + 1 quanta of two clocks times the prescaler.
fn register_rate(btr0: u32, btr1: u32) -> u32 {
    let clocks_a_quantum = 2 * ((btr0 & 0x3F) + 1);
    let quanta = 1 + (btr1 & 0xF) + 1 + (btr1 >> 4 & 7) + 1;
    SJA1000_HZ / (clocks_a_quantum * quanta)
}

#[cfg(test)]
mod tests;
