//! Interference on the receiver's cable: flipped bits, swallowed characters, stray bytes between frames.

use crate::{
    random::Random,
    time::Ps,
    wire::{LineFormat, Parity, UartChar},
};

const SINGLE_FLIP: f64 = 0.02;
const DOUBLE_FLIP: f64 = 0.01;
const SWALLOWED: f64 = 0.01;
const STRAY_IN_GAP: f64 = 0.5;

pub(super) struct LineNoise {
    random: Random,
}

impl LineNoise {
    pub(super) fn new(random: Random) -> Self {
        Self { random }
    }

    /// Disturbs one frame and the gap after it.
    pub(super) fn disturb(
        &mut self,
        characters: &mut Vec<UartChar>,
        frame_start: Ps,
        period: Ps,
        character_time: Ps,
        format: LineFormat,
    ) {
        characters.retain(|_| self.random.unit() >= SWALLOWED);
        for character in characters.iter_mut() {
            self.flip(character);
        }
        if self.random.unit() < STRAY_IN_GAP {
            let end = characters
                .last()
                .map_or(frame_start, |last| last.start + character_time);
            let room = (frame_start + period).saturating_sub(end + 2 * character_time);
            characters.push(UartChar {
                start: end + (self.random.unit() * room as f64) as Ps,
                byte: self.random.byte(),
                format,
            });
        }
    }

    /// One flipped data bit leaves the sent parity bit wrong, two leave it right.
    fn flip(&mut self, character: &mut UartChar) {
        let draw = self.random.unit();
        if draw >= SINGLE_FLIP + DOUBLE_FLIP {
            return;
        }
        let first = self.random.below(8);
        character.byte ^= 1 << first;
        if draw < DOUBLE_FLIP {
            let second = (first + 1 + self.random.below(7)) % 8;
            character.byte ^= 1 << second;
        } else {
            character.format.parity = match character.format.parity {
                Parity::None => Parity::None,
                Parity::Even => Parity::Odd,
                Parity::Odd => Parity::Even,
            };
        }
    }
}
