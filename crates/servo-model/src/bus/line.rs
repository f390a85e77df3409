//! The wire: who sent which byte when, and what a UART makes of it.
//!
//! A byte is a start bit (low), eight data bits from the lowest on, and a stop bit (high). The wire is low while anyone sends a low
//! bit, so two that send at once destroy each other's bytes, and a UART of another baud rate hears something else.

use std::collections::VecDeque;

/// Who takes part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    Host,
    /// A servo, by its place in the list.
    Servo(usize),
}

/// One byte on the wire.
#[derive(Clone, Copy, Debug)]
pub struct Sent {
    pub by: Party,
    pub start_ns: u64,
    pub end_ns: u64,
    pub baud: u32,
    pub byte: u8,
}

/// Bits of a byte with start and stop.
const BITS: u64 = 10;

/// Length of so many bits, ns, rounded up so that a bit is there at its start.
fn bits_ns(bits: u64, baud: u32) -> u64 {
    (bits * 1_000_000_000).div_ceil(u64::from(baud.max(1)))
}

/// Length of a byte, ns.
pub fn byte_ns(baud: u32) -> u64 {
    bits_ns(BITS, baud)
}

impl Sent {
    pub fn new(by: Party, start_ns: u64, baud: u32, byte: u8) -> Self {
        Self {
            by,
            start_ns,
            end_ns: start_ns + byte_ns(baud),
            baud,
            byte,
        }
    }

    /// Whether it holds the wire low at a time.
    fn is_low(&self, at_ns: u64) -> bool {
        if !(self.start_ns..self.end_ns).contains(&at_ns) {
            return false;
        }
        let bit = (at_ns - self.start_ns) * u64::from(self.baud) / 1_000_000_000;
        match bit {
            0 => true,
            1..=8 => self.byte >> (bit - 1) & 1 == 0,
            _ => false,
        }
    }

    /// The first time from `from_ns` on at which it holds the wire low.
    fn first_low(&self, from_ns: u64) -> Option<u64> {
        if self.end_ns <= from_ns {
            return None;
        }
        if from_ns <= self.start_ns {
            return Some(self.start_ns);
        }
        (0..BITS - 1)
            .map(|bit| {
                let start = self.start_ns + bits_ns(bit, self.baud);
                start.max(from_ns)
            })
            .find(|at_ns| self.is_low(*at_ns))
    }
}

/// The bytes that are on the wire, and those of the last moment.
#[derive(Clone, Debug, Default)]
pub struct Line {
    sent: VecDeque<Sent>,
}

impl Line {
    /// Puts a byte on the wire. Bytes come in the order of their starts.
    pub fn put(&mut self, sent: Sent) {
        self.sent.push_back(sent);
    }

    /// Forgets bytes that have ended at a time.
    pub fn forget(&mut self, now_ns: u64) {
        while self
            .sent
            .front()
            .is_some_and(|first| first.end_ns <= now_ns)
        {
            self.sent.pop_front();
        }
    }

    fn is_low(&self, at_ns: u64) -> bool {
        self.sent.iter().any(|sent| sent.is_low(at_ns))
    }

    fn is_busy_with(&self, party: Party, at_ns: u64) -> bool {
        self.sent
            .iter()
            .any(|sent| sent.by == party && (sent.start_ns..sent.end_ns).contains(&at_ns))
    }

    /// The byte that has the wire for itself from `start_ns` on.
    fn alone(&self, start_ns: u64, end_ns: u64) -> Option<&Sent> {
        let mut there = self
            .sent
            .iter()
            .filter(|sent| sent.start_ns < end_ns && start_ns < sent.end_ns);
        there.next().filter(|_| there.next().is_none())
    }
}

/// The receiving half of a UART.
#[derive(Clone, Debug)]
pub struct Ear {
    party: Party,
    /// Whether it hears what its own party sends.
    pub hears_itself: bool,
    /// From when on it looks for a start bit.
    free_ns: u64,
    /// Start of the byte that it is receiving, and the baud rate of then.
    receiving: Option<(u64, u32)>,
}

impl Ear {
    pub fn new(party: Party) -> Self {
        Self {
            party,
            hears_itself: false,
            free_ns: 0,
            receiving: None,
        }
    }

    /// Listens from a time on, and forgets what it was receiving.
    pub fn restart(&mut self, from_ns: u64) {
        self.free_ns = from_ns;
        self.receiving = None;
    }

    /// Looks for the start of a byte if it receives none, after the wire has changed.
    pub fn listen(&mut self, line: &Line, baud: u32) {
        if self.receiving.is_some() {
            return;
        }
        let mut from_ns = self.free_ns;
        loop {
            let low = line
                .sent
                .iter()
                .filter_map(|sent| sent.first_low(from_ns))
                .min();
            let Some(at_ns) = low else { return };
            if self.hears_itself || !line.is_busy_with(self.party, at_ns) {
                self.receiving = Some((at_ns, baud));
                return;
            }
            // Its own bytes: it listens again when they are over.
            let own = line.sent.iter().filter(|sent| sent.by == self.party);
            from_ns = own
                .map(|sent| sent.end_ns)
                .max()
                .unwrap_or(at_ns)
                .max(at_ns + 1);
        }
    }

    /// When the byte that it is receiving ends.
    pub fn ends_ns(&self) -> Option<u64> {
        self.receiving
            .map(|(start_ns, baud)| start_ns + byte_ns(baud))
    }

    /// Ends the byte that it is receiving. `None` if there was no stop bit, or no start bit longer than a spike.
    pub fn take(&mut self, line: &Line) -> Option<u8> {
        let (start_ns, baud) = self.receiving.take()?;
        let end_ns = start_ns + byte_ns(baud);
        if let Some(sent) = line.alone(start_ns, end_ns)
            && sent.start_ns == start_ns
            && sent.baud == baud
        {
            self.free_ns = end_ns;
            return Some(sent.byte);
        }
        let middle = |bit: u64| start_ns + bits_ns(2 * bit + 1, 2 * baud);
        if !line.is_low(middle(0)) {
            self.free_ns = middle(0);
            return None;
        }
        let byte = (1..=8).fold(0, |byte, bit| {
            byte | u8::from(!line.is_low(middle(bit))) << (bit - 1)
        });
        self.free_ns = middle(9);
        if !line.is_low(middle(9)) {
            return Some(byte);
        }
        // A framing error: it waits until the wire is high again.
        let step_ns = bits_ns(1, baud).max(16) / 16;
        while line.is_low(self.free_ns) {
            self.free_ns += step_ns;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(sent: &[Sent], baud: u32) -> Vec<u8> {
        let mut line = Line::default();
        sent.iter().for_each(|sent| line.put(*sent));
        let mut ear = Ear::new(Party::Host);
        let mut bytes = Vec::new();
        loop {
            ear.listen(&line, baud);
            if ear.ends_ns().is_none() {
                return bytes;
            }
            bytes.extend(ear.take(&line));
        }
    }

    fn sent(servo: usize, start_ns: u64, baud: u32, byte: u8) -> Sent {
        Sent::new(Party::Servo(servo), start_ns, baud, byte)
    }

    #[test]
    fn bytes_one_after_the_other_are_heard() {
        let sent = [0xFF, 0x00, 0xA5]
            .iter()
            .zip(0..)
            .map(|(byte, place)| sent(0, 500 + place * 10_000, 1_000_000, *byte));
        let sent: Vec<_> = sent.collect();
        assert_eq!(heard(&sent, 1_000_000), [0xFF, 0x00, 0xA5]);
    }

    // The wire carries the AND of both: 0xF0 & 0x3C.
    #[test]
    fn two_at_once_are_heard_as_their_low_bits_together() {
        let both = [
            sent(0, 1000, 1_000_000, 0xF0),
            sent(1, 1000, 1_000_000, 0x3C),
        ];
        assert_eq!(heard(&both, 1_000_000), [0x30]);
    }

    // 0x55 at 500 kb/s is low and high for 2 µs in turn. At 1 Mb/s the first byte has no stop bit at 9.5 µs. The next starts when the
    // wire falls at 12 µs, and has bits 0 11 00 11 from the lowest on, and then the idle wire.
    #[test]
    fn another_baud_rate_hears_something_else() {
        let slow = [sent(0, 0, 500_000, 0x55)];
        let fast = heard(&slow, 1_000_000);
        assert_eq!(fast, [0b1110_0110]);
        assert_ne!(heard(&[sent(0, 0, 1_000_000, 0x55)], 500_000), [0x55]);
    }

    #[test]
    fn a_frame_without_its_stop_bit_is_dropped() {
        // A zero at 115,200 b/s is low for 78 µs: at 1 Mb/s no byte ends in that.
        assert_eq!(heard(&[sent(0, 0, 115_200, 0x00)], 1_000_000), []);
    }
}
