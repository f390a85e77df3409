//! The dialogue that a motor must complete before it may be enabled.

mod dm4310;
mod rs00;

use super::{
    super::layout::JointMotor,
    protocol::{Expected, Status},
};
use crate::domain::{CanFrame, JointMode};

/// An unanswered request is repeated after this time.
const REPLY_TIMEOUT_US: u64 = 10_000;

/// The dialogue with one motor. Between its requests the motor gets disable frames.
#[derive(Clone, Debug)]
pub enum SetUp {
    Dm4310(dm4310::SetUp),
    Rs00(rs00::SetUp),
}

impl SetUp {
    /// `mode` is the control mode to set. `Off` needs none of its own and counts as `Mit`.
    pub fn new(motor: &'static JointMotor, mode: JointMode) -> Self {
        match motor {
            JointMotor::Dm4310(motor) => Self::Dm4310(dm4310::SetUp::new(motor, mode)),
            JointMotor::Rs00(motor) => Self::Rs00(rs00::SetUp::new(motor, mode)),
        }
    }

    /// Returns the next request, if one is due.
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

    /// Restarts the dialogue, unless the motor is expected to be silent.
    pub fn on_silence(&mut self, now_us: u64) {
        match self {
            Self::Dm4310(set_up) => set_up.on_silence(now_us),
            Self::Rs00(set_up) => set_up.on_silence(),
        }
    }
}

/// Whether a request may be sent, for the first time or again.
fn is_due(requested_us: Option<u64>, timeout_us: u64, now_us: u64) -> bool {
    requested_us.is_none_or(|requested_us| now_us.saturating_sub(requested_us) >= timeout_us)
}

#[cfg(test)]
mod tests;
