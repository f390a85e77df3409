//! DM4310: disabled, ranges as in the layout, time-out 100 ms, the wanted control mode; each read, and what can be
//! written is written if it is wrong and read again.

use super::{
    super::dialect::{Expected, Status},
    PATIENCE_US, is_due,
};
use crate::{
    domain::{CanFrame, JointMode},
    motor::dm4310::{ControlMode, Dm4310, Register},
};

/// 100 ms in steps of 50 µs: silence of the board after which an enabled motor lets go.
const TIMEOUT_COUNTS: u32 = 2_000;
/// A motor may be silent for some 150 ms while it takes a value.
const WRITE_US: u64 = 300_000;
/// A motor with other ranges than the layout's is looked at again after this long.
const WRONG_RANGE_US: u64 = 1_000_000;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Disable,
    Read(Register),
    Write(Register),
    /// The codes would mean other values than the layout says: never to be enabled.
    WrongRange,
    Done,
}

#[derive(Clone, Debug)]
pub struct SetUp {
    motor: &'static Dm4310,
    mode: ControlMode,
    step: Step,
    asked_us: Option<u64>,
}

impl SetUp {
    pub fn new(motor: &'static Dm4310, mode: JointMode) -> Self {
        Self {
            motor,
            mode: match mode {
                JointMode::Off | JointMode::Mit => ControlMode::Mit,
                JointMode::PositionSpeed => ControlMode::PositionSpeed,
                JointMode::Speed => ControlMode::Speed,
            },
            step: Step::Disable,
            asked_us: None,
        }
    }

    pub fn request(&mut self, now_us: u64) -> Option<CanFrame> {
        if !is_due(self.asked_us, self.patience_us(), now_us) {
            return None;
        }
        self.step = match self.step {
            Step::WrongRange => Step::Disable,
            // A write that was not answered in time may have been heard all the same.
            Step::Write(register) if self.asked_us.is_some() => Step::Read(register),
            step => step,
        };
        self.asked_us = Some(now_us);
        match self.step {
            Step::Read(register) => Some(self.motor.read_register(register)),
            Step::Write(register) => self
                .wanted(register)
                .map(|value| self.motor.write_register(register, value)),
            Step::Disable | Step::WrongRange | Step::Done => None,
        }
    }

    fn patience_us(&self) -> u64 {
        match self.step {
            Step::Write(_) => WRITE_US,
            Step::WrongRange => WRONG_RANGE_US,
            Step::Disable | Step::Read(_) | Step::Done => PATIENCE_US,
        }
    }

    pub fn expected(&self) -> Expected {
        match self.step {
            Step::Read(register) | Step::Write(register) => Expected::Register(register),
            Step::Disable | Step::WrongRange | Step::Done => Expected::Report,
        }
    }

    pub fn on_report(&mut self, status: Status) {
        if self.step == Step::Disable && status == Status::Disabled {
            self.go_to(Step::Read(Register::PositionRange));
        }
    }

    pub fn on_register(&mut self, value: u32, now_us: u64) {
        match self.step {
            Step::Read(register) => self.judge(register, value, now_us),
            Step::Write(register) => self.go_to(Step::Read(register)),
            Step::Disable | Step::WrongRange | Step::Done => {}
        }
    }

    fn judge(&mut self, register: Register, value: u32, now_us: u64) {
        let ranges = self.motor.ranges();
        let next = match register {
            Register::PositionRange if is_range(value, ranges.p_max_rad) => {
                Step::Read(Register::VelocityRange)
            }
            Register::VelocityRange if is_range(value, ranges.v_max_rps) => {
                Step::Read(Register::TorqueRange)
            }
            Register::TorqueRange if is_range(value, ranges.t_max_nm) => {
                Step::Read(Register::Timeout)
            }
            Register::PositionRange | Register::VelocityRange | Register::TorqueRange => {
                self.step = Step::WrongRange;
                self.asked_us = Some(now_us);
                return;
            }
            setting if self.wanted(setting) != Some(value) => Step::Write(setting),
            Register::Timeout => Step::Read(Register::ControlMode),
            Register::ControlMode => Step::Done,
        };
        self.go_to(next);
    }

    /// `None` for what must not be changed.
    fn wanted(&self, register: Register) -> Option<u32> {
        match register {
            Register::Timeout => Some(TIMEOUT_COUNTS),
            Register::ControlMode => Some(self.mode as u32),
            Register::PositionRange | Register::VelocityRange | Register::TorqueRange => None,
        }
    }

    pub fn is_done(&self) -> bool {
        self.step == Step::Done
    }

    pub fn on_silence(&mut self, now_us: u64) {
        let may_be_silent = match (self.step, self.asked_us) {
            (Step::Disable, _) => true,
            (Step::Write(_), Some(asked_us)) => now_us.saturating_sub(asked_us) < WRITE_US,
            _ => false,
        };
        if !may_be_silent {
            self.go_to(Step::Disable);
        }
    }

    fn go_to(&mut self, step: Step) {
        self.step = step;
        self.asked_us = None;
    }
}

fn is_range(value: u32, range: f32) -> bool {
    (f32::from_bits(value) - range).abs() <= 1e-3
}
