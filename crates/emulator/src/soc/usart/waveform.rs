//! The level of a UART line over time, reconstructed from what happens on it.

use std::collections::VecDeque;

use crate::{
    time::{Ps, SECOND},
    wire::{LineEvent, Parity, UartChar},
};

/// What happened last on one line, in the order of the start times; idle (high) outside of it.
#[derive(Debug, Default)]
pub struct Waveform {
    events: VecDeque<LineEvent>,
}

impl Waveform {
    pub fn push(&mut self, event: LineEvent) {
        self.events.push_back(event);
    }

    /// Drops what ended at or before `now`.
    pub fn forget_before(&mut self, now: Ps) {
        while self.events.front().is_some_and(|event| end(event) <= now) {
            self.events.pop_front();
        }
    }

    pub fn is_high(&self, at: Ps) -> bool {
        self.started(at).all(|event| level(event, at))
    }

    /// The first change from high to low at or after `from`, as far as the line is known.
    pub fn falling_edge_from(&self, from: Ps) -> Option<Ps> {
        self.events
            .iter()
            .flat_map(|event| (0..edges(event)).map(|index| edge(event, index)))
            .find(|&at| at >= from && !self.is_high(at) && self.is_high(at.wrapping_sub(1)))
    }

    /// The end of the last hold that began before `now`.
    pub fn released_at(&self, now: Ps) -> Option<Ps> {
        let ends = self.started(now).filter_map(|event| match event {
            LineEvent::Low { until, .. } => Some(*until),
            LineEvent::Character(_) => None,
        });
        ends.max()
    }

    fn started(&self, at: Ps) -> impl Iterator<Item = &LineEvent> {
        self.events
            .iter()
            .take_while(move |event| event.start() <= at)
    }
}

/// Instants at which the level may fall.
fn edges(event: &LineEvent) -> u32 {
    match event {
        LineEvent::Character(character) => character.format.bits(),
        LineEvent::Low { .. } => 1,
    }
}

fn edge(event: &LineEvent, index: u32) -> Ps {
    match event {
        LineEvent::Character(character) => bit_start(character, index),
        LineEvent::Low { from, .. } => *from,
    }
}

fn end(event: &LineEvent) -> Ps {
    match event {
        LineEvent::Character(character) => bit_start(character, character.format.bits()),
        LineEvent::Low { until, .. } => *until,
    }
}

/// Start time of bit `index`, counted from the start bit.
fn bit_start(c: &UartChar, index: u32) -> Ps {
    c.start + Ps::from(index) * SECOND / Ps::from(c.format.baud)
}

fn level(event: &LineEvent, at: Ps) -> bool {
    if at < event.start() || at >= end(event) {
        return true;
    }
    match event {
        LineEvent::Character(character) => bit_level(character, at),
        LineEvent::Low { .. } => false,
    }
}

/// The level while the character is on the line.
fn bit_level(c: &UartChar, at: Ps) -> bool {
    // The last bit whose start time, which is rounded down, is not after `at`.
    let bit = (((at - c.start + 1) * Ps::from(c.format.baud) - 1) / SECOND) as u8;
    let data_bits = c.format.data_bits;
    match bit {
        0 => false,
        n if n <= data_bits => u16::from(c.byte) >> (n - 1) & 1 == 1,
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
        line.push(LineEvent::Character(UartChar {
            start: 100 * US,
            byte: 0x0F,
            format,
        }));
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
