//! The receive half: oversampling of the line, as RM0090 30.3.3 describes it.

use crate::{
    time::{Ps, SECOND},
    wire::{LineEvent, LineFormat, Parity, UartChar},
};

use super::waveform::Waveform;

/// Settings of the receiver, which define one character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Framing {
    /// One bit, at the programmed baud rate.
    pub bit: Ps,
    /// Bits of a word by the M bit: 8 or 9, parity bit included.
    pub word_bits: u8,
    pub parity: Parity,
    pub two_stop_bits: bool,
    pub oversampling_8: bool,
    /// ONEBIT: the middle sample alone decides, and noise is not detected.
    pub one_sample: bool,
}

impl Framing {
    /// The format of the line, as a device at its other end must be set.
    pub fn format(&self) -> LineFormat {
        LineFormat {
            baud: ((SECOND + self.bit / 2) / self.bit) as u32,
            data_bits: self.word_bits - u8::from(self.parity != Parity::None),
            parity: self.parity,
            stop_bits: if self.two_stop_bits { 2 } else { 1 },
        }
    }

    /// Duration of a character from the start bit to the end of the stop bits.
    pub fn char_time(&self) -> Ps {
        self.bit * (1 + Ps::from(self.word_bits) + if self.two_stop_bits { 2 } else { 1 })
    }

    /// Time from the start edge until the character is in DR. That is the 10th sample of a single stop bit, or the end of
    /// the first of two (RM0090 30.3.3, configurable stop bits).
    fn completion(&self) -> Ps {
        let before_stop = self.bit * (1 + Ps::from(self.word_bits));
        before_stop
            + if self.two_stop_bits {
                self.bit
            } else {
                self.bit * 10 / 16
            }
    }

    /// The three sampling instants of bit `index` after the start edge.
    fn samples(&self, index: u8) -> [Ps; 3] {
        let (of, first) = if self.oversampling_8 { (8, 3) } else { (16, 7) };
        let start = self.bit * Ps::from(index);
        // Samples are numbered from 1 and fall in the middle of their clock.
        [first, first + 1, first + 2].map(|n| start + self.bit * (2 * n + 1) / (2 * of))
    }
}

/// A character as received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received {
    /// DR: 8 or 9 bits, the parity bit at the top where there is one.
    pub data: u16,
    pub framing_error: bool,
    pub parity_error: bool,
    pub noise: bool,
}

/// Hunts for start bits and samples characters.
#[derive(Debug, Default)]
pub struct Receiver {
    line: Waveform,
    last_character: Option<UartChar>,
    /// Start edge of the character being received.
    start: Option<Ps>,
    /// Start edges before this time no longer count.
    search_from: Ps,
}

impl Receiver {
    pub fn push(&mut self, event: LineEvent) {
        self.line.push(event);
        if let LineEvent::Character(character) = event {
            self.last_character = Some(character);
        }
    }

    /// The sender's last character, for the error message.
    pub fn last_character(&self) -> Option<UartChar> {
        self.last_character
    }

    /// Where the search for the next start edge begins.
    pub fn searching_from(&self) -> Ps {
        self.search_from
    }

    /// When the line that a device holds or held low before `now` is released; `None` if no such time is known any more.
    pub fn released_at(&self, now: Ps) -> Option<Ps> {
        self.line.released_at(now)
    }

    /// Drops what was being received; edges before `now` no longer count.
    pub fn restart(&mut self, now: Ps) {
        self.start = None;
        self.search_from = now;
    }

    /// Time at which the character being received will be complete; `None` while no start edge is known.
    pub fn completes_at(&mut self, framing: &Framing) -> Option<Ps> {
        if self.start.is_none() {
            self.line.forget_before(self.search_from);
            self.start = self.line.falling_edge_from(self.search_from);
        }
        Some(self.start? + framing.completion())
    }

    /// Ends the character whose completion `completes_at` returned; `None` if its start bit was a glitch.
    pub fn finish(&mut self, framing: &Framing) -> Option<(Ps, Received)> {
        let start = self.start.take()?;
        let sample = |index: u8| self.sample(start, framing, index);
        let (start_bit, start_noise) = sample(0);
        if start_bit {
            self.search_from = start + framing.bit / 2;
            return None;
        }
        let (mut data, mut noise) = (0u16, start_noise);
        for index in 0..framing.word_bits {
            let (bit, noisy) = sample(index + 1);
            data |= u16::from(bit) << index;
            noise |= noisy;
        }
        let (stop_bit, stop_noise) = sample(framing.word_bits + 1);
        let parity_error = match framing.parity {
            Parity::None => false,
            Parity::Even => data.count_ones() % 2 == 1,
            Parity::Odd => data.count_ones() % 2 == 0,
        };
        self.search_from = start + framing.completion();
        Some((
            start,
            Received {
                data,
                framing_error: !stop_bit,
                parity_error,
                noise: noise || stop_noise,
            },
        ))
    }

    fn sample(&self, start: Ps, framing: &Framing, index: u8) -> (bool, bool) {
        let levels = framing.samples(index).map(|t| self.line.is_high(start + t));
        if framing.one_sample {
            return (levels[1], false);
        }
        let ones = levels.iter().filter(|level| **level).count();
        (ones >= 2, ones == 1 || ones == 2)
    }
}

#[cfg(test)]
mod tests {
    use crate::time::US;

    use super::*;

    const SBUS: LineFormat = LineFormat {
        baud: 100_000,
        data_bits: 8,
        parity: Parity::Even,
        stop_bits: 2,
    };
    const EIGHT_E_TWO: Framing = Framing {
        bit: 10 * US,
        word_bits: 9,
        parity: Parity::Even,
        two_stop_bits: true,
        oversampling_8: false,
        one_sample: false,
    };
    const EIGHT_N_ONE: Framing = Framing {
        word_bits: 8,
        parity: Parity::None,
        two_stop_bits: false,
        ..EIGHT_E_TWO
    };

    fn receive(byte: u8, framing: Framing) -> (Ps, Received) {
        let mut receiver = Receiver::default();
        receiver.push(LineEvent::Character(UartChar {
            start: 50 * US,
            byte,
            format: SBUS,
        }));
        let at = receiver.completes_at(&framing).expect("a start edge");
        (at, receiver.finish(&framing).expect("a character").1)
    }

    #[test]
    fn matching_formats_give_the_byte_and_its_parity_bit_at_the_end_of_the_first_stop_bit() {
        let (at, got) = receive(0x07, EIGHT_E_TWO);
        // Three ones give an even parity bit of 1, which is received as bit 8.
        let clean = Received {
            data: 0x107,
            framing_error: false,
            parity_error: false,
            noise: false,
        };
        assert_eq!(got, clean);
        assert_eq!(at, 50 * US + 110 * US);
    }

    #[test]
    fn eight_n_one_takes_the_parity_bit_for_a_stop_bit() {
        // With an even number of ones the parity bit is 0 where the stop bit should be.
        assert!(receive(0x0F, EIGHT_N_ONE).1.framing_error);
        // With an odd number of ones the parity bit is 1 and passes for a stop bit.
        let (_, got) = receive(0x07, EIGHT_N_ONE);
        assert_eq!((got.data, got.framing_error), (0x07, false));
    }

    #[test]
    fn a_receiver_at_twice_the_rate_reads_each_bit_twice() {
        let fast = Framing {
            bit: 5 * US,
            ..EIGHT_N_ONE
        };
        // 0x0F LSB first after the start bit: 0 0 1 1 1 1 1 1 1: sampled after the fast start bit 0,1,1,…
        let (_, got) = receive(0x0F, fast);
        assert_eq!(got.data, 0b1111_1110);
        assert!(!got.framing_error);
    }

    #[test]
    fn an_edge_between_the_three_samples_is_noise() {
        // 5.2 % fast: the parity bit's samples fall at 89.8, 90.4 and 90.9 µs, around the edge at 90 µs from the
        // last data bit (0) to the parity bit of a single one (1).
        let skewed = Framing {
            bit: 9_480_000,
            ..EIGHT_E_TWO
        };
        let (_, got) = receive(0x01, skewed);
        assert!(got.noise);
        assert_eq!(got.data, 0x101);
    }
}
