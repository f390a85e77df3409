//! The level of a UART line over time, reconstructed from the characters sent on it.

use std::collections::VecDeque;

use crate::{
    time::{Ps, SECOND},
    wire::{Parity, UartChar},
};

/// The last characters on one line; idle (high) outside them.
#[derive(Debug, Default)]
pub struct Waveform {
    chars: VecDeque<UartChar>,
}

impl Waveform {
    pub fn push(&mut self, c: UartChar) {
        self.chars.push_back(c);
    }

    /// Drops what ended at or before `now`.
    pub fn forget_before(&mut self, now: Ps) {
        while self.chars.front().is_some_and(|c| end(c) <= now) {
            self.chars.pop_front();
        }
    }

    pub fn is_high(&self, at: Ps) -> bool {
        self.chars.iter().all(|c| level(c, at))
    }

    /// The first change from high to low at or after `from`, among the characters known.
    pub fn falling_edge_from(&self, from: Ps) -> Option<Ps> {
        self.chars
            .iter()
            .flat_map(|c| (0..bits(c)).map(|bit| edge(c, bit)))
            .find(|&at| at >= from && !self.is_high(at) && self.is_high(at.wrapping_sub(1)))
    }
}

/// Bits of the character on the line, start and stop bits included.
fn bits(c: &UartChar) -> u32 {
    let parity = u32::from(c.format.parity != Parity::None);
    1 + u32::from(c.format.data_bits) + parity + u32::from(c.format.stop_bits)
}

/// Start time of bit `index`, counted from the start bit.
fn edge(c: &UartChar, index: u32) -> Ps {
    c.start + (u128::from(index) * u128::from(SECOND) / u128::from(c.format.baud)) as Ps
}

fn end(c: &UartChar) -> Ps {
    edge(c, bits(c))
}

fn level(c: &UartChar, at: Ps) -> bool {
    if at < c.start || at >= end(c) {
        return true;
    }
    let bit = (0..bits(c)).take_while(|&i| edge(c, i) <= at).count() as u8 - 1;
    let data_bits = c.format.data_bits;
    match bit {
        0 => false,
        n if n <= data_bits => c.byte >> (n - 1) & 1 == 1,
        n if n == data_bits + 1 && c.format.parity != Parity::None => parity_bit(c),
        _ => true,
    }
}

fn parity_bit(c: &UartChar) -> bool {
    let data = c.byte & (0xFFu16 >> (8 - c.format.data_bits.min(8))) as u8;
    let odd_ones = data.count_ones() % 2 == 1;
    odd_ones == (c.format.parity == Parity::Even)
}

#[cfg(test)]
mod tests {
    use crate::{time::US, wire::LineFormat};

    use super::*;

    #[test]
    fn an_sbus_header_byte_draws_its_twelve_bits() {
        // 0x0F, 8E2 at 10 µs a bit: start 0, data 1111 0000 (LSB first), even parity of four ones 0, stop 11.
        let format = LineFormat {
            baud: 100_000,
            data_bits: 8,
            parity: Parity::Even,
            stop_bits: 2,
        };
        let mut line = Waveform::default();
        line.push(UartChar {
            start: 100 * US,
            byte: 0x0F,
            format,
        });
        let seen: String = (0..12)
            .map(|bit| {
                if line.is_high(100 * US + bit * 10 * US + 5 * US) {
                    '1'
                } else {
                    '0'
                }
            })
            .collect();
        assert_eq!(seen, "011110000011");
        assert_eq!(line.falling_edge_from(100 * US), Some(100 * US));
        assert_eq!(line.falling_edge_from(100 * US + 1), Some(150 * US));
        assert_eq!(line.falling_edge_from(150 * US + 1), None);
    }
}
