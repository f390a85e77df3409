//! Plays the pattern of an indication.

use super::{
    Indication,
    patterns::{Beeps, Colour, Step, pattern},
};
use crate::domain::age_us;

/// LED and buzzer now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    pub led: Colour,
    pub buzzer: bool,
}

/// Call [`step`](Self::step) a hundred times a second: the shortest step is 80 ms.
#[derive(Clone, Debug, Default)]
pub struct IndicationPlayer {
    shown: Option<Indication>,
    since_us: u64,
}

impl IndicationPlayer {
    /// An indication that was not shown before starts at the beginning of its pattern.
    pub fn step(&mut self, indication: Indication, now_us: u64) -> Signal {
        if self.shown != Some(indication) {
            self.shown = Some(indication);
            self.since_us = now_us;
        }
        let elapsed_ms = age_us(self.since_us, now_us) / 1_000;
        let pattern = pattern(indication);
        Signal {
            led: repeated(pattern.led, elapsed_ms).unwrap_or(Colour::Off),
            buzzer: match pattern.beeps {
                Beeps::Silent => None,
                Beeps::Once(steps) => at(steps, elapsed_ms),
                Beeps::Repeated(steps) => repeated(steps, elapsed_ms),
            }
            .unwrap_or(false),
        }
    }
}

fn repeated<T: Copy>(steps: &[Step<T>], elapsed_ms: u32) -> Option<T> {
    let total_ms = steps.iter().map(|(_, ms)| ms).sum::<u32>();
    at(steps, elapsed_ms.checked_rem(total_ms)?)
}

/// `None` past the last step.
fn at<T: Copy>(steps: &[Step<T>], elapsed_ms: u32) -> Option<T> {
    let mut left_ms = elapsed_ms;
    for &(value, ms) in steps {
        if left_ms < ms {
            return Some(value);
        }
        left_ms = left_ms.saturating_sub(ms);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const START_US: u64 = 7_000_000;

    fn play(player: &mut IndicationPlayer, indication: Indication, at_ms: u64) -> (Colour, bool) {
        let signal = player.step(indication, START_US + at_ms * 1_000);
        (signal.led, signal.buzzer)
    }

    #[test]
    fn a_new_indication_starts_at_the_beginning_of_its_pattern() {
        let mut player = IndicationPlayer::default();
        assert_eq!(
            play(&mut player, Indication::Ready, 0),
            (Colour::Blue, true)
        );
        assert!(play(&mut player, Indication::Ready, 70).1);
        assert!(!play(&mut player, Indication::Ready, 80).1);
        assert_eq!(
            play(&mut player, Indication::Ready, 700),
            (Colour::Off, false)
        );
        assert_eq!(
            play(&mut player, Indication::Armed, 710),
            (Colour::Green, true)
        );
        assert!(play(&mut player, Indication::Armed, 1_009).1);
        assert!(!play(&mut player, Indication::Armed, 1_010).1);
        assert_eq!(
            play(&mut player, Indication::Armed, 60_000),
            (Colour::Green, false)
        );
    }

    /// Three short beeps, then quiet until 3 s after the first; red on and off five times a second.
    #[test]
    fn an_alarm_goes_on() {
        let mut player = IndicationPlayer::default();
        let heard: Vec<u64> = (0..600)
            .map(|step| step * 10)
            .filter(|ms| play(&mut player, Indication::LatchedStop, *ms).1)
            .collect();
        let starts: Vec<u64> = heard
            .iter()
            .copied()
            .filter(|ms| !heard.contains(&ms.wrapping_sub(10)))
            .collect();
        assert_eq!(starts, [0, 200, 400, 3_000, 3_200, 3_400]);
        assert_eq!(heard.len(), 60);
        let reds = (0..100)
            .filter(|step| {
                play(&mut player, Indication::LatchedStop, 6_000 + step * 10).0 == Colour::Red
            })
            .count();
        assert_eq!(reds, 50);
    }
}
