//! The power supply of the flash, and the step at which it is cut.

use super::error::FlashError;

/// The moment within a step at which the power is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The step has changed nothing yet.
    Before,
    /// The word or the sector is torn.
    Middle,
    /// The step is complete, but the processor has not seen that.
    After,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Done,
    CutBefore,
    CutInTheMiddle,
    CutAfter,
}

impl Outcome {
    pub fn result(self) -> Result<(), FlashError> {
        match self {
            Self::Done => Ok(()),
            Self::CutBefore | Self::CutInTheMiddle | Self::CutAfter => Err(FlashError::PowerLost),
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
enum Supply {
    #[default]
    On,
    OnUntil {
        step: u64,
        phase: Phase,
    },
    Off,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Power {
    supply: Supply,
    steps: u64,
}

impl Power {
    pub fn check(&self) -> Result<(), FlashError> {
        match self.supply {
            Supply::Off => Err(FlashError::PowerLost),
            Supply::On | Supply::OnUntil { .. } => Ok(()),
        }
    }

    pub fn steps(&self) -> u64 {
        self.steps
    }

    pub fn cut_at(&mut self, step: u64, phase: Phase) {
        self.supply = Supply::OnUntil { step, phase };
    }

    pub fn restored(self) -> Self {
        Self {
            supply: Supply::On,
            ..self
        }
    }

    pub fn begin_step(&mut self) -> Result<Outcome, FlashError> {
        self.check()?;
        let number = self.steps;
        self.steps += 1;
        let phase = match self.supply {
            Supply::OnUntil { step, phase } if step == number => phase,
            _ => return Ok(Outcome::Done),
        };
        self.supply = Supply::Off;
        Ok(match phase {
            Phase::Before => Outcome::CutBefore,
            Phase::Middle => Outcome::CutInTheMiddle,
            Phase::After => Outcome::CutAfter,
        })
    }
}
