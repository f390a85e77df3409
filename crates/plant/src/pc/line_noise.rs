//! Interference on the cable: flipped bits, swallowed characters, stop bits that are not there.

use crate::{
    random::Random,
    wire::{LineEvent, UartChar},
};

const SINGLE_FLIP: f64 = 0.01;
const DOUBLE_FLIP: f64 = 0.005;
const SWALLOWED: f64 = 0.005;
const NO_STOP_BIT: f64 = 0.002;

#[derive(Clone, Debug)]
pub(super) struct LineNoise {
    random: Random,
}

impl LineNoise {
    pub(super) fn new(random: Random) -> Self {
        Self { random }
    }

    /// The character as it arrives, if it does. Without parity a flipped bit shows in the checksum only.
    pub(super) fn disturb(&mut self, mut sent: UartChar) -> Option<LineEvent> {
        let draw = self.random.unit();
        let [swallowed, single, double, no_stop_bit] =
            sums([SWALLOWED, SINGLE_FLIP, DOUBLE_FLIP, NO_STOP_BIT]);
        if draw < swallowed {
            return None;
        }
        let first = self.random.below(8);
        if draw < double {
            sent.byte ^= 1 << first;
        }
        if (single..double).contains(&draw) {
            sent.byte ^= 1 << ((first + 1 + self.random.below(7)) % 8);
        }
        if (double..no_stop_bit).contains(&draw) {
            return Some(LineEvent::Low {
                from: sent.start,
                until: sent.start + sent.format.char_time() * 98 / 100,
            });
        }
        Some(LineEvent::Character(sent))
    }
}

/// The sums of the first one, two, three and four values.
fn sums(values: [f64; 4]) -> [f64; 4] {
    let mut sum = 0.0;
    values.map(|value| {
        sum += value;
        sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{random::Stream, serial_adapter::LINK_FORMAT};

    #[test]
    fn each_kind_of_error_has_its_share() {
        let mut noise = LineNoise::new(Random::new(3, Stream::LinkDown));
        let mut kinds = [0; 5];
        for _ in 0..100_000 {
            let sent = UartChar {
                start: 0,
                byte: 0x5A,
                format: LINK_FORMAT,
            };
            let kind = match noise.disturb(sent) {
                None => 0,
                Some(LineEvent::Low { .. }) => 3,
                Some(LineEvent::Character(heard)) => match (heard.byte ^ 0x5A).count_ones() {
                    0 => 4,
                    flips => flips as usize,
                },
            };
            kinds[kind] += 1;
        }
        let [swallowed, single, double, no_stop_bit, whole] = kinds;
        assert!((400..600).contains(&swallowed), "{kinds:?}");
        assert!((850..1_150).contains(&single), "{kinds:?}");
        assert!((400..600).contains(&double), "{kinds:?}");
        assert!((130..270).contains(&no_stop_bit), "{kinds:?}");
        assert!(whole > 97_000, "{kinds:?}");
    }
}
