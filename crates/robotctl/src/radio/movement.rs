//! Finds the channel that moved between two positions of the transmitter.

use std::array;

use super::{Control, MappedControl};

/// Counts of all channels as on the wire, from 0 to 2047.
pub type Frame = [u16; 16];

/// While one control is held at its end, any other channel must move by less than this.
const MOST_BESIDE: u16 = 150;
/// A control that is held varies by less than this.
const MOST_SPREAD: u16 = 60;

/// The channels in a position that was held for a while.
#[derive(Clone, Copy, Debug)]
pub struct HeldPosition {
    pub median: Frame,
    spread: Frame,
}

impl HeldPosition {
    /// Returns `None` if there is no frame.
    pub fn of(frames: &[Frame]) -> Option<Self> {
        let sorted = |index| sorted(frames, index);
        let middle = frames.len() / 2;
        (!frames.is_empty()).then(|| Self {
            median: array::from_fn(|index| sorted(index)[middle]),
            spread: array::from_fn(|index| {
                let counts = sorted(index);
                counts[counts.len() - 1] - counts[0]
            }),
        })
    }

    /// Fails unless all controls are where they were.
    pub fn check_back(&self, now: &Self) -> Result<(), MoveError> {
        let mut moved = (0..16).map(|index| now.median[index].abs_diff(self.median[index]));
        match moved.position(|counts| counts >= MOST_BESIDE) {
            Some(index) => Err(MoveError::NotBack { index }),
            None => Ok(()),
        }
    }
}

/// Returns the counts of one channel, lowest first.
pub(super) fn sorted(frames: &[Frame], index: usize) -> Vec<u16> {
    let mut counts: Vec<u16> = frames.iter().map(|frame| frame[index]).collect();
    counts.sort_unstable();
    counts
}

/// A channel that moved from rest to where the pilot was asked to put its control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Movement {
    pub control: Control,
    /// Index of the channel, from 0 to 15.
    pub index: usize,
    pub from: u16,
    pub to: u16,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MoveError {
    #[error(
        "{name}: nothing moved (channel {index} by {counts} counts at most, {least} are wanted): hold it at its very end, \
         and see that the transmitter sends it on a channel"
    )]
    Nothing {
        name: &'static str,
        index: usize,
        counts: u16,
        least: u16,
    },
    #[error(
        "{name}: channels {index} and {other} both moved: put all other controls back as they were at the start, and \
         switch off mixers that send one control on two channels"
    )]
    Several {
        name: &'static str,
        index: usize,
        other: usize,
    },
    #[error(
        "{name}: channel {index} moved, which is {other} already: move the control that was asked for, or give it a channel \
         of its own in the transmitter"
    )]
    Taken {
        name: &'static str,
        index: usize,
        other: &'static str,
    },
    #[error("{name}: channel {index} went to and fro by {counts} counts: hold it still")]
    Unsteady {
        name: &'static str,
        index: usize,
        counts: u16,
    },
    #[error(
        "{name}: channel {index} went from {from} to {to}, which does not reach what the robot wants (docs/driving.md): \
         widen its limits in the transmitter"
    )]
    Short {
        name: &'static str,
        index: usize,
        from: u16,
        to: u16,
    },
    #[error(
        "channel {index} is not back: enable off, e-stop at stop, mode at manual, stand switch at sit, knobs in their \
         middle, sticks let go"
    )]
    NotBack { index: usize },
    #[error(
        "{name}: channel {index} went from {low} over {centre} to {high}, and was at {held} when held: move the sticks \
         slowly along all their edges, and see to the limits in the transmitter"
    )]
    Ends {
        name: &'static str,
        index: usize,
        low: u16,
        centre: u16,
        high: u16,
        held: u16,
    },
}

impl Movement {
    /// Finds the only channel that moved from `rest`.
    pub fn find(
        control: Control,
        rest: &HeldPosition,
        held: &HeldPosition,
        found: &[MappedControl],
    ) -> Result<Self, MoveError> {
        let name = control.name();
        let moved = |index: usize| held.median[index].abs_diff(rest.median[index]);
        let mut by_travel: [usize; 16] = array::from_fn(|index| index);
        by_travel.sort_by_key(|&index| std::cmp::Reverse(moved(index)));
        let [index, other, ..] = by_travel;
        let least = control.least_move();
        if moved(index) < least {
            let counts = moved(index);
            return Err(MoveError::Nothing {
                name,
                index,
                counts,
                least,
            });
        }
        if moved(other) >= MOST_BESIDE {
            return Err(MoveError::Several { name, index, other });
        }
        if let Some(taken) = found.iter().find(|found| found.has(index)) {
            let other = taken.control.name();
            return Err(MoveError::Taken { name, index, other });
        }
        let counts = held.spread[index].max(rest.spread[index]);
        if counts > MOST_SPREAD {
            return Err(MoveError::Unsteady {
                name,
                index,
                counts,
            });
        }
        let (from, to) = (rest.median[index], held.median[index]);
        if !control.is_reached(from, to) {
            return Err(MoveError::Short {
                name,
                index,
                from,
                to,
            });
        }
        Ok(Self {
            control,
            index,
            from,
            to,
        })
    }

    /// True if the high end has the lower count.
    pub fn is_reversed(&self) -> bool {
        (self.to > self.from) != self.control.goes_up()
    }
}
