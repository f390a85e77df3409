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

#[derive(Clone)]
pub(super) struct LineNoise {
    random: Random,
}

impl LineNoise {
    pub(super) fn new(random: Random) -> Self {
        Self { random }
    }

    /// Disturbs one frame and the gap that follows it.
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

    /// Flips no, one or two data bits. With one flipped bit the parity is wrong, with two it is right.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        radio::sbus,
        random::Stream,
        time::{MS, US},
    };

    const SENT: u8 = 0x5A;
    const CHARACTER: Ps = 120 * US;

    fn disturbed_frames(count: usize) -> Vec<Vec<UartChar>> {
        let mut noise = LineNoise::new(Random::new(3, Stream::RadioLine));
        (0..count)
            .map(|_| {
                let mut characters: Vec<UartChar> = (0..25)
                    .map(|index| UartChar {
                        start: index * CHARACTER,
                        byte: SENT,
                        format: sbus::FORMAT,
                    })
                    .collect();
                noise.disturb(&mut characters, 0, 7 * MS, CHARACTER, sbus::FORMAT);
                characters
            })
            .collect()
    }

    #[test]
    fn parity_betrays_one_flipped_bit_but_not_two() {
        let frames = disturbed_frames(4_000);
        let (mut single, mut double) = (0, 0);
        // Stray characters start off the grid of the sent ones.
        let sent = |c: &&UartChar| c.start.is_multiple_of(CHARACTER) && c.start < 25 * CHARACTER;
        for character in frames.iter().flatten().filter(sent) {
            match (
                (character.byte ^ SENT).count_ones(),
                character.format.parity,
            ) {
                (0, Parity::Even) => {}
                (1, Parity::Odd) => single += 1,
                (2, Parity::Even) => double += 1,
                other => panic!("{other:?}"),
            }
        }
        // 2 % and 1 % of 100,000 characters.
        assert!((1_700..2_300).contains(&single), "{single}");
        assert!((800..1_200).contains(&double), "{double}");
    }

    #[test]
    fn characters_never_overlap_nor_reach_into_the_next_frame() {
        for frame in disturbed_frames(1_000) {
            assert!(
                frame
                    .windows(2)
                    .all(|w| w[0].start + CHARACTER <= w[1].start)
            );
            assert!(frame.iter().all(|c| c.start + CHARACTER <= 7 * MS));
        }
    }
}
