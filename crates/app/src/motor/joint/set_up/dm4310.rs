//! Set-up of a DM4310: disable it, compare its ranges with the layout, set its time-out of 100 ms and its control
//! mode. Each register is read; a writable one with a wrong value is written and read again.

use super::{
    super::protocol::{Expected, Status},
    REPLY_TIMEOUT_US, is_due,
};
use crate::{
    domain::{CanFrame, JointMode},
    motor::dm4310::{ControlMode, Dm4310, Register},
};

/// 100 ms in steps of 50 µs. An enabled motor releases torque when the board has been silent for this long.
const TIMEOUT_COUNTS: u32 = 2_000;
/// A motor may be silent for about 150 ms after a write.
const WRITE_TIMEOUT_US: u64 = 300_000;
/// A motor whose ranges differ from the layout is checked again after this time.
const RANGE_RETRY_US: u64 = 1_000_000;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Disable,
    Read(Register),
    Write(Register),
    /// The motor's codes would mean other values than the layout says. It is never enabled.
    WrongRange,
    Done,
}

#[derive(Clone, Debug)]
pub struct SetUp {
    motor: &'static Dm4310,
    mode: ControlMode,
    step: Step,
    requested_us: Option<u64>,
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
            requested_us: None,
        }
    }

    pub fn request(&mut self, now_us: u64) -> Option<CanFrame> {
        if !is_due(self.requested_us, self.timeout_us(), now_us) {
            return None;
        }
        self.step = match self.step {
            Step::WrongRange => Step::Disable,
            // A write without a timely answer may have been executed, so the register is read.
            Step::Write(register) if self.requested_us.is_some() => Step::Read(register),
            step => step,
        };
        self.requested_us = Some(now_us);
        match self.step {
            Step::Read(register) => Some(self.motor.read_register(register)),
            Step::Write(register) => self
                .target_value(register)
                .map(|value| self.motor.write_register(register, value)),
            Step::Disable | Step::WrongRange | Step::Done => None,
        }
    }

    fn timeout_us(&self) -> u64 {
        match self.step {
            Step::Write(_) => WRITE_TIMEOUT_US,
            Step::WrongRange => RANGE_RETRY_US,
            Step::Disable | Step::Read(_) | Step::Done => REPLY_TIMEOUT_US,
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
            self.enter(Step::Read(Register::PositionRange));
        }
    }

    pub fn on_register(&mut self, value: u32, now_us: u64) {
        match self.step {
            Step::Read(register) => self.check(register, value, now_us),
            Step::Write(register) => self.enter(Step::Read(register)),
            Step::Disable | Step::WrongRange | Step::Done => {}
        }
    }

    fn check(&mut self, register: Register, value: u32, now_us: u64) {
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
                self.requested_us = Some(now_us);
                return;
            }
            setting if self.target_value(setting) != Some(value) => Step::Write(setting),
            Register::Timeout => Step::Read(Register::ControlMode),
            Register::ControlMode => Step::Done,
        };
        self.enter(next);
    }

    /// The value to write, or `None` for a register that must not be changed.
    fn target_value(&self, register: Register) -> Option<u32> {
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
        let silence_expected = match (self.step, self.requested_us) {
            (Step::Disable, _) => true,
            (Step::Write(_), Some(requested_us)) => {
                now_us.saturating_sub(requested_us) < WRITE_TIMEOUT_US
            }
            _ => false,
        };
        if !silence_expected {
            self.enter(Step::Disable);
        }
    }

    fn enter(&mut self, step: Step) {
        self.step = step;
        self.requested_us = None;
    }
}

fn is_range(value: u32, range: f32) -> bool {
    (f32::from_bits(value) - range).abs() <= 1e-3
}
