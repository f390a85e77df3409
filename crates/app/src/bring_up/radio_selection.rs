//! Detects flicks of the left stick up or down.

/// A stick beyond this position is flicked.
const FLICKED: f32 = 0.7;
/// A stick inside this range is ready for the next flick.
const CENTRED: f32 = 0.5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flick {
    Up,
    Down,
}

/// Detects a flick only from the centre. A throttle stick without a spring, at rest at its end, does not count.
#[derive(Clone, Debug, Default)]
pub struct FlickDetector {
    centred: bool,
}

impl FlickDetector {
    /// Takes the position of the stick, −1…1, up positive.
    pub fn step(&mut self, stick: f32) -> Option<Flick> {
        if stick.abs() < CENTRED {
            self.centred = true;
            return None;
        }
        if !self.centred || stick.abs() <= FLICKED {
            return None;
        }
        self.centred = false;
        Some(if stick > 0.0 { Flick::Up } else { Flick::Down })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flick_counts_once_from_the_centre() {
        let mut detector = FlickDetector::default();
        let flicks: Vec<_> = [
            -1.0,
            0.5,
            0.8,
            0.0,
            0.6,
            0.8,
            1.0,
            0.6,
            0.8,
            0.4,
            -0.71,
            -1.0,
            f32::NAN,
        ]
        .into_iter()
        .map(|stick| detector.step(stick))
        .collect();
        let mut expected = [None; 13];
        expected[5] = Some(Flick::Up);
        expected[10] = Some(Flick::Down);
        assert_eq!(flicks, expected);
    }
}
