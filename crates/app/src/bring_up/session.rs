//! Which step bring-up is in, who picks it, and the command that replaces the pilot's.

use super::{
    limits,
    radio_gesture::RadioGesture,
    radio_selection::{Flick, FlickDetector},
    request::{BringUpRequest, TestMotor, Trial, TrialAction},
    status::{BringUpStatus, BringUpStep, TrialState},
    trial::{DeadMan, TrialInputs, TrialRun},
};
use crate::{
    domain::{
        ChassisCommand, DriveMode, MotorFeedback, OperatorState, RemoteState, WheelOdomConfig,
    },
    safety::ArmingState,
};

/// Steering stick beyond this for the gesture: all the way to the left.
const GESTURE_STICK: f32 = 0.9;

/// All that bring-up looks at in one tick.
#[derive(Clone, Copy, Debug)]
pub struct BringUpInputs<'a> {
    pub remote: &'a RemoteState,
    pub operator: &'a OperatorState,
    /// Age of the last frame that came over the air.
    pub remote_age_us: u32,
    pub arming: ArmingState,
    pub motor: &'a MotorFeedback,
    pub wheel_odom: &'a WheelOdomConfig,
}

impl BringUpInputs<'_> {
    fn fresh(&self) -> bool {
        self.remote_age_us <= limits::REMOTE_AGE_US
    }

    fn dead_man(&self) -> DeadMan {
        match (self.fresh(), self.operator.dead_man) {
            (false, _) => DeadMan::Unknown,
            (true, true) => DeadMan::Held,
            (true, false) => DeadMan::LetGo,
        }
    }

    /// Step and motor change only while no motor can move.
    fn may_change(&self) -> bool {
        self.fresh() && self.operator.disabled && self.arming == ArmingState::Disarmed
    }
}

/// Who picks step and motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Control {
    TuningChannel,
    /// The mode switch counts from when it has been back at its near end: the gesture ends at the far one.
    Radio {
        switch_counts: bool,
    },
}

/// Off after every boot.
#[derive(Clone, Debug)]
pub struct BringUp {
    stage: BringUpRequest,
    control: Control,
    gesture: RadioGesture,
    flicks: FlickDetector,
    /// Picked by the radio.
    motor: TestMotor,
    trial: TrialRun,
    status: BringUpStatus,
}

impl Default for BringUp {
    fn default() -> Self {
        Self {
            stage: BringUpRequest::Off,
            control: Control::TuningChannel,
            gesture: RadioGesture::default(),
            flicks: FlickDetector::default(),
            motor: TestMotor::FIRST,
            trial: TrialRun::default(),
            status: BringUpStatus::default(),
        }
    }
}

impl BringUp {
    /// From the tuning channel, which makes sure that the robot is disarmed.
    pub fn request(&mut self, request: BringUpRequest) {
        self.control = Control::TuningChannel;
        self.stage = request;
    }

    /// Before `Arming` in each tick. The command that goes to the motors in place of any other, with the permit and the
    /// limits that every command needs; `None` while bring-up is off.
    pub fn step(&mut self, inputs: &BringUpInputs<'_>, now_us: u64) -> Option<ChassisCommand> {
        self.follow_radio(inputs, now_us);
        let command = self.command(inputs, now_us);
        self.record();
        command
    }

    /// In the first step nothing may be armed.
    pub fn blocks_arming(&self) -> bool {
        self.stage == BringUpRequest::ReadOnly
    }

    /// In the other steps motors are enabled as soon as the robot is armed.
    pub fn tries_motors(&self) -> bool {
        !matches!(self.stage, BringUpRequest::Off | BringUpRequest::ReadOnly)
    }

    pub fn status(&self) -> &BringUpStatus {
        &self.status
    }

    fn follow_radio(&mut self, inputs: &BringUpInputs<'_>, now_us: u64) {
        let held =
            inputs.may_change() && inputs.operator.e_stop && inputs.remote.wz > GESTURE_STICK;
        if self.gesture.step(held, inputs.operator.mode, now_us) {
            self.control = Control::Radio {
                switch_counts: false,
            };
            self.stage = BringUpRequest::ReadOnly;
        }
        if inputs.may_change() {
            self.select(inputs);
        }
    }

    fn select(&mut self, inputs: &BringUpInputs<'_>) {
        let flick = self.flicks.step(inputs.remote.select);
        let Control::Radio { switch_counts } = &mut self.control else {
            return;
        };
        *switch_counts |= inputs.operator.mode == DriveMode::Manual;
        if !*switch_counts {
            return;
        }
        self.motor = match flick {
            Some(Flick::Up) => self.motor.next(),
            Some(Flick::Down) => self.motor.previous(),
            None => self.motor,
        };
        self.stage = match inputs.operator.mode {
            DriveMode::Manual => BringUpRequest::ReadOnly,
            DriveMode::Pc => BringUpRequest::ZeroTorque,
            DriveMode::Custom => BringUpRequest::OneMotor(Trial {
                motor: self.motor,
                action: TrialAction::StickTorque,
            }),
        };
    }

    fn command(&mut self, inputs: &BringUpInputs<'_>, now_us: u64) -> Option<ChassisCommand> {
        let BringUpRequest::OneMotor(trial) = &self.stage else {
            return (self.stage != BringUpRequest::Off).then(ChassisCommand::default);
        };
        if inputs.arming == ArmingState::Disarmed {
            self.trial.reset();
            return Some(ChassisCommand::default());
        }
        let trial_inputs = TrialInputs {
            dead_man: inputs.dead_man(),
            drive: inputs.remote.vx,
            motor: inputs.motor,
            wheel_odom: inputs.wheel_odom,
        };
        Some(self.trial.step(trial, &trial_inputs, now_us))
    }

    fn record(&mut self) {
        let (step, motor) = match self.stage {
            BringUpRequest::Off => (BringUpStep::Off, self.motor),
            BringUpRequest::ReadOnly => (BringUpStep::ReadOnly, self.motor),
            BringUpRequest::ZeroTorque => (BringUpStep::ZeroTorque, self.motor),
            BringUpRequest::OneMotor(trial) => (BringUpStep::OneMotor, trial.motor),
        };
        self.status = BringUpStatus {
            step,
            motor: motor.number(),
            trial: if step == BringUpStep::OneMotor {
                self.trial.state()
            } else {
                TrialState::Idle
            },
            by_radio: matches!(self.control, Control::Radio { .. }),
        };
    }
}

#[cfg(test)]
mod tests;
