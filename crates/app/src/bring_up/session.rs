//! The bring-up session: its step, who selects it, and the command that replaces the pilot's.

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

/// The gesture needs the steering stick beyond this position, fully to the left.
const GESTURE_STICK: f32 = 0.9;

/// Inputs of bring-up in one tick.
#[derive(Clone, Copy, Debug)]
pub struct BringUpInputs<'a> {
    /// The pilot's sticks.
    pub remote: &'a RemoteState,
    /// The pilot's switches.
    pub operator: &'a OperatorState,
    /// Age of the last frame received over the air, in µs.
    pub remote_age_us: u32,
    /// Whether the robot is armed.
    pub arming: ArmingState,
    /// Feedback of all motors.
    pub motor: &'a MotorFeedback,
    /// Geometry of the wheels.
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
            (true, false) => DeadMan::Released,
        }
    }

    /// Whether step and motor may change, which needs that no motor can move.
    fn may_change(&self) -> bool {
        self.fresh() && self.operator.disabled && self.arming == ArmingState::Disarmed
    }
}

/// Who selects step and motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Control {
    TuningChannel,
    /// The gesture ends with the mode switch at custom. The switch counts once it has been back at manual.
    Radio {
        switch_counts: bool,
    },
}

/// A bring-up session. It is off after every boot.
///
/// ```
/// use robot_app::bring_up::{BringUp, BringUpInputs, BringUpRequest};
/// use robot_app::domain::{ChassisCommand, MotorFeedback, OperatorState, RemoteState, WheelOdomConfig};
/// use robot_app::safety::ArmingState;
///
/// let inputs = BringUpInputs {
///     remote: &RemoteState::default(),
///     operator: &OperatorState::default(),
///     remote_age_us: 0,
///     arming: ArmingState::Disarmed,
///     motor: &MotorFeedback::default(),
///     wheel_odom: &WheelOdomConfig::default(),
/// };
/// let mut bring_up = BringUp::default();
/// assert_eq!(bring_up.step(&inputs, 1_000), None);
/// bring_up.request(BringUpRequest::ReadOnly);
/// assert_eq!(bring_up.step(&inputs, 2_000), Some(ChassisCommand::STOP));
/// assert!(bring_up.blocks_arming());
/// ```
#[derive(Clone, Debug)]
pub struct BringUp {
    stage: BringUpRequest,
    control: Control,
    gesture: RadioGesture,
    flicks: FlickDetector,
    /// The motor selected by the radio.
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
    /// Takes a request from the tuning channel, which ensures that the robot is disarmed.
    pub fn request(&mut self, request: BringUpRequest) {
        self.control = Control::TuningChannel;
        self.stage = request;
    }

    /// Advances by one tick, before `Arming`. Returns the command that replaces any other, or `None` while bring-up
    /// is off. The command is subject to the usual permit and limits.
    pub fn step(&mut self, inputs: &BringUpInputs<'_>, now_us: u64) -> Option<ChassisCommand> {
        self.follow_radio(inputs, now_us);
        let command = self.command(inputs, now_us);
        self.record();
        command
    }

    /// Whether the session is in its first step, which blocks arming.
    pub fn blocks_arming(&self) -> bool {
        self.stage == BringUpRequest::ReadOnly
    }

    /// Whether the session is in a step that enables motors when the robot is armed.
    pub fn tests_motors(&self) -> bool {
        !matches!(self.stage, BringUpRequest::Off | BringUpRequest::ReadOnly)
    }

    /// State of the session, for diagnostics.
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
