//! Plays the pattern of an indication.

use super::{
    Indication,
    patterns::{Beeps, Colour, Step, pattern},
};
use crate::domain::age_us;

/// What LED and buzzer do now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Colour of the LED.
    pub led: Colour,
    /// Whether the buzzer sounds.
    pub buzzer: bool,
}

/// Plays the pattern of the current indication. Call [`step`](Self::step) at 100 Hz, as the shortest element lasts 80
/// ms.
///
/// ```
/// use robot_app::indication::{Colour, Indication, IndicationPlayer};
///
/// let mut player = IndicationPlayer::default();
/// let start = player.step(Indication::Ready, 1_000_000);
/// assert_eq!((start.led, start.buzzer), (Colour::Blue, true)); // beeps once
/// let later = player.step(Indication::Ready, 1_600_000);
/// assert_eq!((later.led, later.buzzer), (Colour::Off, false)); // blinks
/// ```
#[derive(Clone, Debug, Default)]
pub struct IndicationPlayer {
    shown: Option<Indication>,
    since_us: u64,
}

impl IndicationPlayer {
    /// Returns the signal at `now_us`. A new indication starts at the beginning of its pattern.
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

/// Returns the value at `elapsed_ms`, or `None` past the last element.
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

    /// The buzzer gives three short beeps and is quiet until 3 s after the first. The LED turns red five times a
    /// second.
    #[test]
    fn an_alarm_repeats_until_it_ends() {
        let mut player = IndicationPlayer::default();
        let sounding: Vec<u64> = (0..600)
            .map(|step| step * 10)
            .filter(|ms| play(&mut player, Indication::LatchedStop, *ms).1)
            .collect();
        let starts: Vec<u64> = sounding
            .iter()
            .copied()
            .filter(|ms| !sounding.contains(&ms.wrapping_sub(10)))
            .collect();
        assert_eq!(starts, [0, 200, 400, 3_000, 3_200, 3_400]);
        assert_eq!(sounding.len(), 60);
        let reds = (0..100)
            .filter(|step| {
                play(&mut player, Indication::LatchedStop, 6_000 + step * 10).0 == Colour::Red
            })
            .count();
        assert_eq!(reds, 50);
    }
}
