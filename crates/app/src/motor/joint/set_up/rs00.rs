//! RS00: stopped, no fault, the wanted run mode. Nothing can be read back but the fault word.

use super::{super::dialect::Expected, PATIENCE_US, is_due};
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
    asked_us: Option<u64>,
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
            asked_us: None,
        }
    }

    pub fn request(&mut self, now_us: u64) -> Option<CanFrame> {
        if !is_due(self.asked_us, PATIENCE_US, now_us) {
            return None;
        }
        self.asked_us = Some(now_us);
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

    /// The motor replies to each frame once, so a report after an order is the answer to it.
    pub fn on_report(&mut self) {
        if self.asked_us.is_none() {
            return;
        }
        match self.step {
            Step::Stop => self.go_to(Step::ReadFaults),
            Step::SetMode => self.go_to(Step::Done),
            Step::ReadFaults | Step::Done => {}
        }
    }

    pub fn on_no_fault(&mut self) {
        if self.step == Step::ReadFaults {
            self.go_to(Step::SetMode);
        }
    }

    pub fn is_done(&self) -> bool {
        self.step == Step::Done
    }

    pub fn on_silence(&mut self) {
        if self.step != Step::Stop {
            self.go_to(Step::Stop);
        }
    }

    fn go_to(&mut self, step: Step) {
        self.step = step;
        self.asked_us = None;
    }
}
