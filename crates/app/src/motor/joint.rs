//! One joint motor: set-up, enabling, commands, faults. It limits each command, whoever sent it.

mod axis;
mod freeze_detector;
mod protocol;
mod set_up;

use self::{
    freeze_detector::FreezeDetector,
    protocol::{Expected, Reply, Report, Status},
    set_up::SetUp,
};
use super::{
    interface::Motor,
    joint_limits::{MotorLimits, limit_command},
    layout::JointSlot,
    mit::MitTargets,
};
use crate::{
    domain::{CanFrame, JointCommand, JointConfig, JointFeedback, JointMode, JointState, age_us},
    math::scalar,
};

/// Enable frames are sent in each slot for this long.
const ENABLE_WINDOW_US: u64 = 10_000;
/// If the motor has not followed, they are sent again after this time. In between the motor gets disable frames.
const ENABLE_PERIOD_US: u64 = 250_000;
/// Consecutive replies with state disabled after which an enabled motor counts as disabled. A single one may have
/// been on its way.
const DISABLED_REPLIES: u8 = 2;
/// Slots between two reads of the fault word of a motor whose replies do not show every fault.
const FAULT_POLL_SLOTS: u8 = 64;
/// Slots in which that word may come, the one of its request included: a motor may answer later than its next command.
const FAULT_WORD_SLOTS: u8 = 4;

/// Six steps of the DM4310's speed codes of 0.015 rad/s each.
const STATIONARY_RPS: f32 = 0.1;

/// Why no stationary angle is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotStationary {
    /// The motor does not report, repeats an old report, or its ranges are not yet confirmed.
    Unknown,
    /// The motor is turning.
    Moving,
}

/// State of the motor's start-up sequence.
#[derive(Clone, Debug)]
enum Phase {
    SettingUp(SetUp),
    Disabled,
    Enabling,
    Enabled { disabled_replies: u8 },
    Fault,
}

/// The last frame sent, as far as it affects how the reply is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LastRequest {
    Enable,
    Other,
}

#[derive(Clone, Debug)]
pub struct Joint {
    slot: &'static JointSlot,
    tick: u8,
    phase: Phase,
    /// The control mode that the motor is set to.
    mode: JointMode,
    report: Option<Report>,
    report_ts_us: u64,
    age_us: u32,
    is_silent: bool,
    frozen: bool,
    freeze_detector: FreezeDetector,
    fault_code: u32,
    last_request: LastRequest,
    enable_began_us: Option<u64>,
    clear_requested: bool,
    slots_to_fault_poll: u8,
    sent: JointCommand,
    /// The same in motor coordinates, while the motor is enabled in MIT mode.
    active_targets: Option<MitTargets>,
}

impl Joint {
    pub fn new(slot: &'static JointSlot) -> Self {
        Self {
            slot,
            tick: 0,
            phase: Phase::SettingUp(SetUp::new(&slot.motor, JointMode::Mit)),
            mode: JointMode::Mit,
            report: None,
            report_ts_us: 0,
            age_us: u32::MAX,
            is_silent: true,
            frozen: false,
            freeze_detector: FreezeDetector::default(),
            fault_code: 0,
            last_request: LastRequest::Other,
            enable_began_us: None,
            clear_requested: false,
            slots_to_fault_poll: FAULT_POLL_SLOTS - FAULT_WORD_SLOTS,
            sent: JointCommand::default(),
            active_targets: None,
        }
    }

    /// Clears the fault of a motor in fault; the motor is then set up again.
    pub fn clear_fault(&mut self) {
        self.clear_requested = matches!(self.phase, Phase::Fault);
    }

    /// Excludes a stall of the chip from the age of the last report.
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        if self.report.is_some() {
            self.report_ts_us = self.report_ts_us.saturating_add(stall_us.into());
        }
        self.freeze_detector.restart(now_us);
    }

    /// The command that the motor follows, zero unless it is enabled.
    pub fn sent(&self) -> &JointCommand {
        &self.sent
    }

    /// The angle of the stationary motor in motor coordinates, from its newest report. It serves to redefine the
    /// joint's zero.
    pub fn stationary_angle_rad(&self) -> Result<f32, NotStationary> {
        let is_ready = match self.state() {
            JointState::Silent | JointState::SettingUp => false,
            JointState::Disabled
            | JointState::Enabling
            | JointState::Enabled
            | JointState::Fault => !self.frozen,
        };
        match &self.report {
            Some(report) if is_ready && report.motion.vel_rps.abs() <= STATIONARY_RPS => {
                Ok(report.motion.pos_rad)
            }
            Some(_) if is_ready => Err(NotStationary::Moving),
            _ => Err(NotStationary::Unknown),
        }
    }

    fn state(&self) -> JointState {
        if self.is_silent {
            return JointState::Silent;
        }
        match self.phase {
            Phase::SettingUp(_) => JointState::SettingUp,
            Phase::Disabled => JointState::Disabled,
            Phase::Enabling => JointState::Enabling,
            Phase::Enabled { .. } => JointState::Enabled,
            Phase::Fault => JointState::Fault,
        }
    }

    fn set_up(&mut self, mode: JointMode) {
        self.mode = mode;
        self.fault_code = 0;
        self.phase = Phase::SettingUp(SetUp::new(&self.slot.motor, mode));
    }

    fn expected(&self) -> Expected {
        match &self.phase {
            Phase::SettingUp(set_up) => set_up.expected(),
            _ if self.slots_to_fault_poll > FAULT_POLL_SLOTS - FAULT_WORD_SLOTS => {
                Expected::FaultWord
            }
            _ => Expected::Report,
        }
    }

    fn on_report(&mut self, report: Report, ts_us: u64) {
        if let Some(last) = &self.report {
            let active_targets = self.active_targets.as_ref();
            self.frozen = self
                .freeze_detector
                .is_frozen(last, &report, active_targets, ts_us);
        }
        self.report = Some(report);
        if let Status::Fault(code) = report.status {
            self.on_fault(code);
            return;
        }
        match &mut self.phase {
            Phase::SettingUp(set_up) => set_up.on_report(report.status),
            Phase::Enabling => {
                let followed = match report.status {
                    Status::Working => self.last_request == LastRequest::Enable,
                    status => status == Status::Enabled,
                };
                if followed {
                    self.phase = Phase::Enabled {
                        disabled_replies: 0,
                    };
                }
            }
            Phase::Enabled { disabled_replies } => {
                *disabled_replies = if report.status == Status::Disabled {
                    disabled_replies.saturating_add(1)
                } else {
                    0
                };
                if *disabled_replies >= DISABLED_REPLIES {
                    // Its supply may have failed for a moment, which resets its settings.
                    self.set_up(self.mode);
                }
            }
            Phase::Disabled | Phase::Fault => {}
        }
    }

    /// Enters the fault state. `code` 0 means that the motor has not named the fault.
    fn on_fault(&mut self, code: u32) {
        if !matches!(self.phase, Phase::Fault) {
            self.phase = Phase::Fault;
            self.fault_code = 0;
            self.slots_to_fault_poll = 0;
        }
        if code != 0 {
            self.fault_code = code;
        }
    }

    fn finish_set_up(&mut self) {
        if let Phase::SettingUp(set_up) = &self.phase
            && set_up.is_done()
        {
            self.phase = Phase::Disabled;
        }
    }

    /// Returns the frame of this slot. Without a command the motor is disabled before anything else.
    fn next_frame(
        &mut self,
        command: Option<&JointCommand>,
        config: &JointConfig,
        now_us: u64,
    ) -> CanFrame {
        self.last_request = LastRequest::Other;
        self.sent = JointCommand::default();
        self.active_targets = None;
        let has_torque = matches!(self.phase, Phase::Enabling | Phase::Enabled { .. });
        if command.is_none() && has_torque {
            self.phase = Phase::Disabled;
            return self.slot.motor.disable();
        }
        if let Some(frame) = self.priority_frame(now_us) {
            return frame;
        }
        match command {
            Some(command) => self.follow(command, config, now_us),
            None => self.slot.motor.disable(),
        }
    }

    /// Returns the frame that has priority over commands: clearing a fault, set-up, reading the fault word.
    fn priority_frame(&mut self, now_us: u64) -> Option<CanFrame> {
        let motor = &self.slot.motor;
        if core::mem::take(&mut self.clear_requested) {
            self.set_up(JointMode::Mit);
            return Some(motor.clear_fault());
        }
        if let Phase::SettingUp(set_up) = &mut self.phase {
            return Some(set_up.request(now_us).unwrap_or(motor.disable()));
        }
        if let Some(slots) = self.slots_to_fault_poll.checked_sub(1) {
            self.slots_to_fault_poll = slots;
            return None;
        }
        self.slots_to_fault_poll = FAULT_POLL_SLOTS;
        motor.read_faults()
    }

    fn follow(&mut self, command: &JointCommand, config: &JointConfig, now_us: u64) -> CanFrame {
        if self.prepare_mode_change(command.mode) {
            return self.slot.motor.disable();
        }
        match self.phase {
            Phase::Enabled { .. } => self.command_frame(command, config),
            Phase::Disabled | Phase::Enabling => self.enable_frame(now_us),
            Phase::SettingUp(_) | Phase::Fault => self.slot.motor.disable(),
        }
    }

    /// Prepares a change of control mode and returns whether one is under way. A motor follows one mode at a time and
    /// changes it while disabled. Only MIT mode can carry zero torque, so in any other mode `Off` disables the motor.
    fn prepare_mode_change(&mut self, wanted: JointMode) -> bool {
        if matches!(self.phase, Phase::Fault) {
            return false;
        }
        match wanted {
            JointMode::Off if self.mode == JointMode::Mit => false,
            JointMode::Off => {
                self.phase = Phase::Disabled;
                true
            }
            mode if mode == self.mode => false,
            mode => {
                self.set_up(mode);
                true
            }
        }
    }

    fn enable_frame(&mut self, now_us: u64) -> CanFrame {
        self.phase = Phase::Enabling;
        let since_us = |began_us: u64| now_us.saturating_sub(began_us);
        if self
            .enable_began_us
            .is_none_or(|began_us| since_us(began_us) >= ENABLE_PERIOD_US)
        {
            self.enable_began_us = Some(now_us);
        }
        if self
            .enable_began_us
            .is_some_and(|began_us| since_us(began_us) < ENABLE_WINDOW_US)
        {
            self.last_request = LastRequest::Enable;
            self.slot.motor.enable()
        } else {
            self.slot.motor.disable()
        }
    }

    fn command_frame(&mut self, command: &JointCommand, config: &JointConfig) -> CanFrame {
        let period_s = self.slot.schedule.period_s();
        let limits = MotorLimits {
            max_torque_nm: self.slot.max_torque_nm,
            // The report is up to one period old, or older after lost ones, and the command lasts one period.
            horizon_s: period_s + scalar::max(period_s, self.age_us as f32 * 1e-6),
        };
        let allowed = match &self.report {
            Some(report) => {
                let motion = axis::joint_motion(&report.motion, config);
                limit_command(command, motion, config, limits)
            }
            None => JointCommand::default(),
        };
        self.sent = allowed;
        let targets = axis::motor_targets(&allowed, config);
        self.active_targets = (allowed.mode == JointMode::Mit).then_some(targets);
        if allowed.mode == JointMode::Off && self.mode != JointMode::Mit {
            // The command held NaN, which counts as `Off`.
            self.phase = Phase::Disabled;
            return self.slot.motor.disable();
        }
        let max_torque_nm = scalar::min(config.max_torque_nm, limits.max_torque_nm);
        self.slot
            .motor
            .command(allowed.mode, &targets, max_torque_nm)
    }
}

impl Motor for Joint {
    type Command = JointCommand;
    type Config = JointConfig;
    type Feedback = JointFeedback;
    /// The frame, if the motor has its slot in this tick.
    type Output = Option<CanFrame>;

    fn receive(&mut self, frame: &CanFrame, ts_us: u64) -> bool {
        let Some(reply) = self.slot.motor.decode(frame, self.expected()) else {
            return false;
        };
        self.report_ts_us = ts_us;
        match (reply, &mut self.phase) {
            (Reply::Report(report), _) => self.on_report(report, ts_us),
            (Reply::Register(value), Phase::SettingUp(set_up)) => set_up.on_register(value, ts_us),
            (Reply::FaultWord(faults), _) if faults.bits() != 0 => self.on_fault(faults.bits()),
            (Reply::FaultWord(_), Phase::SettingUp(set_up)) => set_up.on_no_fault(),
            (Reply::Register(_) | Reply::FaultWord(_), _) => {}
        }
        self.finish_set_up();
        true
    }

    fn update_age(&mut self, timeout_us: u32, now_us: u64) {
        self.age_us = age_us(self.report_ts_us, now_us);
        self.is_silent = self.age_us > timeout_us;
        if !self.is_silent {
            return;
        }
        self.freeze_detector.restart(now_us);
        match &mut self.phase {
            Phase::SettingUp(set_up) => set_up.on_silence(now_us),
            _ => self.set_up(self.mode),
        }
    }

    fn feedback(&self, config: &JointConfig, feedback: &mut JointFeedback) {
        let Some(report) = &self.report else {
            return;
        };
        feedback.state = self.state();
        feedback.fault_code = self.fault_code;
        feedback.frozen = self.frozen;
        feedback.age_us = self.age_us;
        if feedback.ts_us == self.report_ts_us {
            return;
        }
        let motion = axis::joint_motion(&report.motion, config);
        feedback.pos_rad = motion.pos_rad;
        feedback.vel_rps = motion.vel_rps;
        feedback.torque_nm = axis::joint_torque_nm(&report.motion, config);
        feedback.temperature_c = report.temperature_c;
        feedback.reports_enabled = report.status == Status::Enabled;
        feedback.ts_us = self.report_ts_us;
    }

    fn drive(
        &mut self,
        command: &JointCommand,
        config: &JointConfig,
        permitted: bool,
        now_us: u64,
    ) -> Option<CanFrame> {
        let due = self.slot.schedule.is_due(self.tick);
        self.tick = self.tick.wrapping_add(1);
        if !permitted {
            self.sent = JointCommand::default();
            self.active_targets = None;
        }
        due.then(|| self.next_frame(permitted.then_some(command), config, now_us))
    }
}

#[cfg(test)]
mod tests;
