//! Set-up of an RS00: stop it, check that it has no fault, set its run mode. Only its fault word can be read back.

use super::{super::protocol::Expected, REPLY_TIMEOUT_US, is_due};
use crate::{
    domain::{CanFrame, JointMode},
    motor::rs00::{Rs00, RunMode},
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Stop,
    ReadFaults,
    SetMode,
    Done,
}

#[derive(Clone, Debug)]
pub struct SetUp {
    motor: &'static Rs00,
    mode: RunMode,
    step: Step,
    requested_us: Option<u64>,
}

impl SetUp {
    pub fn new(motor: &'static Rs00, mode: JointMode) -> Self {
        Self {
            motor,
            mode: match mode {
                JointMode::Off | JointMode::Mit => RunMode::Mit,
                JointMode::PositionSpeed => RunMode::Position,
                JointMode::Speed => RunMode::Speed,
            },
            step: Step::Stop,
            requested_us: None,
        }
    }

    pub fn request(&mut self, now_us: u64) -> Option<CanFrame> {
        if !is_due(self.requested_us, REPLY_TIMEOUT_US, now_us) {
            return None;
        }
        self.requested_us = Some(now_us);
        match self.step {
            Step::Stop => Some(self.motor.disable()),
            Step::ReadFaults => Some(self.motor.read_faults()),
            Step::SetMode => Some(self.motor.set_mode(self.mode)),
            Step::Done => None,
        }
    }

    pub fn expected(&self) -> Expected {
        match self.step {
            Step::ReadFaults => Expected::FaultWord,
            Step::Stop | Step::SetMode | Step::Done => Expected::Report,
        }
    }

    /// The motor replies once to each frame, so a report after a request is its answer.
    pub fn on_report(&mut self) {
        if self.requested_us.is_none() {
            return;
        }
        match self.step {
            Step::Stop => self.enter(Step::ReadFaults),
            Step::SetMode => self.enter(Step::Done),
            Step::ReadFaults | Step::Done => {}
        }
    }

    pub fn on_no_fault(&mut self) {
        if self.step == Step::ReadFaults {
            self.enter(Step::SetMode);
        }
    }

    pub fn is_done(&self) -> bool {
        self.step == Step::Done
    }

    pub fn on_silence(&mut self) {
        if self.step != Step::Stop {
            self.enter(Step::Stop);
        }
    }

    fn enter(&mut self, step: Step) {
        self.step = step;
        self.requested_us = None;
    }
}
