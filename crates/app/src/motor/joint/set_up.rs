//! What a motor must say and accept before it may be enabled.

mod dm4310;
mod rs00;

use super::{
    super::layout::JointMotor,
    dialect::{Expected, Status},
};
use crate::domain::{CanFrame, JointMode};

/// An unanswered question is asked again after this long.
const PATIENCE_US: u64 = 10_000;

/// The conversation with one motor. Between its own frames the motor is told to stay off.
#[derive(Clone, Debug)]
pub enum SetUp {
    Dm4310(dm4310::SetUp),
    Rs00(rs00::SetUp),
}

impl SetUp {
    /// `mode` is what the motor shall obey afterwards; `Off` needs none of its own and counts as `Mit`.
    pub fn new(motor: &'static JointMotor, mode: JointMode) -> Self {
        match motor {
            JointMotor::Dm4310(motor) => Self::Dm4310(dm4310::SetUp::new(motor, mode)),
            JointMotor::Rs00(motor) => Self::Rs00(rs00::SetUp::new(motor, mode)),
        }
    }

    /// The next question or order, if one is due.
    pub fn request(&mut self, now_us: u64) -> Option<CanFrame> {
        match self {
            Self::Dm4310(set_up) => set_up.request(now_us),
            Self::Rs00(set_up) => set_up.request(now_us),
        }
    }

    pub fn expected(&self) -> Expected {
        match self {
            Self::Dm4310(set_up) => set_up.expected(),
            Self::Rs00(set_up) => set_up.expected(),
        }
    }

    pub fn on_report(&mut self, status: Status) {
        match self {
            Self::Dm4310(set_up) => set_up.on_report(status),
            Self::Rs00(set_up) => set_up.on_report(),
        }
    }

    pub fn on_register(&mut self, value: u32, now_us: u64) {
        if let Self::Dm4310(set_up) = self {
            set_up.on_register(value, now_us);
        }
    }

    pub fn on_no_fault(&mut self) {
        if let Self::Rs00(set_up) = self {
            set_up.on_no_fault();
        }
    }

    pub fn is_done(&self) -> bool {
        match self {
            Self::Dm4310(set_up) => set_up.is_done(),
            Self::Rs00(set_up) => set_up.is_done(),
        }
    }

    /// Starts anew if the motor has no good reason to be silent.
    pub fn on_silence(&mut self, now_us: u64) {
        match self {
            Self::Dm4310(set_up) => set_up.on_silence(now_us),
            Self::Rs00(set_up) => set_up.on_silence(),
        }
    }
}

/// True if the question asked at `asked_us` may be put, for the first time or again.
fn is_due(asked_us: Option<u64>, patience_us: u64, now_us: u64) -> bool {
    asked_us.is_none_or(|asked_us| now_us.saturating_sub(asked_us) >= patience_us)
}

#[cfg(test)]
mod tests;
