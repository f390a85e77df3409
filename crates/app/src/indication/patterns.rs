//! One LED and one beep pattern for each indication. Colours and rates differ enough to be told apart across a room.

use super::Indication;

/// A colour of the red-green-blue LED.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Colour {
    /// No light.
    Off,
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Red and green.
    Yellow,
    /// Red and blue.
    Purple,
    /// Green and blue.
    Cyan,
    /// All three.
    White,
}

impl Colour {
    /// Whether red, green and blue are on.
    pub const fn red_green_blue(self) -> [bool; 3] {
        match self {
            Self::Off => [false, false, false],
            Self::Red => [true, false, false],
            Self::Green => [false, true, false],
            Self::Blue => [false, false, true],
            Self::Yellow => [true, true, false],
            Self::Purple => [true, false, true],
            Self::Cyan => [false, true, true],
            Self::White => [true, true, true],
        }
    }
}

/// A value and its duration in ms.
pub(super) type Step<T> = (T, u32);

/// What the buzzer plays when the indication appears.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beeps {
    Silent,
    Once(&'static [Step<bool>]),
    Repeated(&'static [Step<bool>]),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Pattern {
    /// Repeated as long as the indication is shown.
    pub led: &'static [Step<Colour>],
    pub beeps: Beeps,
}

pub(super) const fn pattern(indication: Indication) -> Pattern {
    use Colour::{Blue, Cyan, Green, Off, Purple, Red, White, Yellow};
    let (led, beeps): (&[Step<Colour>], Beeps) = match indication {
        Indication::EStop => (&[(Red, 1_000)], Beeps::Once(&[(true, 600)])),
        Indication::BatteryEmpty => (
            &[(Red, 150), (Yellow, 150)],
            Beeps::Repeated(&[(true, 1_000), (false, 500)]),
        ),
        Indication::LatchedStop => (
            &[(Red, 100), (Off, 100)],
            Beeps::Repeated(&[
                (true, 100),
                (false, 100),
                (true, 100),
                (false, 100),
                (true, 100),
                (false, 2_500),
            ]),
        ),
        Indication::RadioLost => (&[(Red, 250), (Blue, 250)], Beeps::Silent),
        Indication::Fault => (&[(Red, 500), (Off, 500)], Beeps::Silent),
        Indication::ArmedInPart => (
            &[(Green, 150), (Red, 150)],
            Beeps::Repeated(&[(true, 150), (false, 850)]),
        ),
        Indication::ArmedBatteryLow => (
            &[(Green, 700), (Yellow, 300)],
            Beeps::Repeated(&[(true, 100), (false, 100), (true, 100), (false, 1_700)]),
        ),
        Indication::BringUpArmed => (&[(Purple, 1_000)], Beeps::Once(&[(true, 300)])),
        Indication::Standing => (
            &[(Green, 700), (Cyan, 300)],
            Beeps::Once(&[(true, 100), (false, 100), (true, 300)]),
        ),
        Indication::Armed => (&[(Green, 1_000)], Beeps::Once(&[(true, 300)])),
        Indication::Waiting => (
            &[(Blue, 150), (Green, 150)],
            Beeps::Repeated(&[(true, 80), (false, 170)]),
        ),
        Indication::BringUp => (&[(Purple, 500), (Off, 500)], Beeps::Silent),
        Indication::BatteryLow => (
            &[(Yellow, 200), (Off, 800)],
            Beeps::Repeated(&[(true, 100), (false, 100), (true, 100), (false, 4_700)]),
        ),
        Indication::WarmingUp => (&[(Cyan, 500), (Off, 500)], Beeps::Silent),
        Indication::HoldStill => (&[(Cyan, 100), (Off, 100)], Beeps::Silent),
        Indication::Calibrating => (&[(Cyan, 1_000)], Beeps::Silent),
        Indication::NotReady => (&[(White, 500), (Off, 500)], Beeps::Silent),
        Indication::Refused => (
            &[(Blue, 100), (Off, 100)],
            Beeps::Once(&[(true, 80), (false, 80), (true, 80)]),
        ),
        Indication::NotSaved => (
            &[(Blue, 500), (White, 500)],
            Beeps::Once(&[(true, 80), (false, 80), (true, 80), (false, 80), (true, 80)]),
        ),
        Indication::Ready => (&[(Blue, 500), (Off, 500)], Beeps::Once(&[(true, 80)])),
    };
    Pattern { led, beeps }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Indication; 20] = [
        Indication::EStop,
        Indication::BatteryEmpty,
        Indication::LatchedStop,
        Indication::RadioLost,
        Indication::Fault,
        Indication::ArmedInPart,
        Indication::ArmedBatteryLow,
        Indication::BringUpArmed,
        Indication::Standing,
        Indication::Armed,
        Indication::Waiting,
        Indication::BringUp,
        Indication::BatteryLow,
        Indication::WarmingUp,
        Indication::HoldStill,
        Indication::Calibrating,
        Indication::NotReady,
        Indication::Refused,
        Indication::NotSaved,
        Indication::Ready,
    ];

    /// What an eye perceives: the colours, and the rate in mHz at which they repeat, 0 for a steady light.
    fn look(indication: Indication) -> (Vec<Colour>, u32) {
        let led = pattern(indication).led;
        let mut colours: Vec<Colour> = led.iter().map(|(colour, _)| *colour).collect();
        colours.sort();
        colours.dedup();
        let period_ms: u32 = led.iter().map(|(_, ms)| ms).sum();
        let millihertz = if colours.len() == 1 {
            0
        } else {
            1_000_000 / period_ms
        };
        (colours, millihertz)
    }

    #[test]
    fn no_two_indications_look_alike() {
        for (index, one) in ALL.into_iter().enumerate() {
            for other in ALL.into_iter().skip(index + 1) {
                let ((colours, rate), (other_colours, other_rate)) = (look(one), look(other));
                let slower = rate.min(other_rate);
                let faster = rate.max(other_rate);
                assert!(
                    colours != other_colours || faster > 2 * slower,
                    "{one:?} looks like {other:?}"
                );
            }
        }
    }

    /// Faster than 7 flashes a second blur; slower than one in two seconds look steady.
    #[test]
    fn patterns_are_slow_enough_to_see_and_hear() {
        for indication in ALL {
            let (_, millihertz) = look(indication);
            assert!(millihertz == 0 || (500..=7_000).contains(&millihertz));
            let pattern = pattern(indication);
            assert!(pattern.led.iter().all(|(_, ms)| *ms >= 80));
            let (Beeps::Once(beeps) | Beeps::Repeated(beeps)) = pattern.beeps else {
                continue;
            };
            assert!(beeps.iter().all(|(_, ms)| *ms >= 80), "{indication:?}");
        }
    }

    #[test]
    fn only_alarms_keep_beeping() {
        let sounding: Vec<Indication> = ALL
            .into_iter()
            .filter(|indication| matches!(pattern(*indication).beeps, Beeps::Repeated(_)))
            .collect();
        assert_eq!(
            sounding,
            [
                Indication::BatteryEmpty,
                Indication::LatchedStop,
                Indication::ArmedInPart,
                Indication::ArmedBatteryLow,
                Indication::Waiting,
                Indication::BatteryLow
            ]
        );
    }
}
