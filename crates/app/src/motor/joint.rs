//! One joint motor: set-up, enabling, commands, faults. What it is told is limited here, whoever asks.

mod axis;
mod dialect;
mod freeze_watch;
mod set_up;

use self::{
    dialect::{Expected, Reply, Report, Status},
    freeze_watch::FreezeWatch,
    set_up::SetUp,
};
use super::{
    interface::Motor,
    joint_limits::{MotorLimits, limited},
    layout::JointSlot,
    mit::MitTargets,
};
use crate::{
    domain::{CanFrame, JointCommand, JointConfig, JointFeedback, JointMode, JointState, age_us},
    math::scalar,
};

/// An enable frame goes out in each slot for this long …
const ENABLE_WINDOW_US: u64 = 10_000;
/// … and if the motor has not followed, again after this long. Meanwhile it is told to stay off.
const ENABLE_PERIOD_US: u64 = 250_000;
/// Replies in a row that call an enabled motor disabled before that is believed: one may have been under way.
const DISABLED_REPLIES: u8 = 2;
/// Slots between two looks at the fault word of a motor that does not show every fault by itself.
const FAULT_POLL_SLOTS: u8 = 64;

/// Some steps of what a DM4310 reports as its speed: 0.015 rad/s each.
const STANDING_RPS: f32 = 0.1;

/// Why a joint stands at no known angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotStanding {
    /// It does not report, repeats an old report, or its ranges are not known yet.
    Unknown,
    Turns,
}

/// How far the motor has been brought.
#[derive(Clone, Debug)]
enum Phase {
    SettingUp(SetUp),
    Disabled,
    Enabling,
    Enabled { disabled_replies: u8 },
    Fault,
}

/// What the last frame was, as far as its reply is read differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Said {
    Enable,
    ReadFaults,
    Other,
}

#[derive(Clone, Debug)]
pub struct Joint {
    slot: &'static JointSlot,
    tick: u8,
    phase: Phase,
    /// What the motor is set to.
    mode: JointMode,
    report: Option<Report>,
    report_ts_us: u64,
    age_us: u32,
    is_silent: bool,
    frozen: bool,
    freeze_watch: FreezeWatch,
    fault_code: u32,
    said: Said,
    enable_began_us: Option<u64>,
    clear_wanted: bool,
    slots_to_fault_poll: u8,
    sent: JointCommand,
    /// The same in motor coordinates, while the motor is enabled and in MIT mode.
    obeyed: Option<MitTargets>,
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
            freeze_watch: FreezeWatch::default(),
            fault_code: 0,
            said: Said::Other,
            enable_began_us: None,
            clear_wanted: false,
            slots_to_fault_poll: FAULT_POLL_SLOTS,
            sent: JointCommand::default(),
            obeyed: None,
        }
    }

    /// A motor in fault is told to forget it and set up again.
    pub fn clear_fault(&mut self) {
        self.clear_wanted = matches!(self.phase, Phase::Fault);
    }

    /// The last report is as old as it would be without the stall.
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        if self.report.is_some() {
            self.report_ts_us = self.report_ts_us.saturating_add(stall_us.into());
        }
        self.freeze_watch.restart(now_us);
    }

    /// The command it obeys, as far as it is enabled.
    pub fn sent(&self) -> &JointCommand {
        &self.sent
    }

    /// Where the motor stands, in its own coordinates: to call that place another angle. Of its newest report, whatever
    /// the settings were when it came.
    pub fn standing_angle_rad(&self) -> Result<f32, NotStanding> {
        let is_ready = match self.state() {
            JointState::Silent | JointState::SettingUp => false,
            JointState::Disabled
            | JointState::Enabling
            | JointState::Enabled
            | JointState::Fault => !self.frozen,
        };
        match &self.report {
            Some(report) if is_ready && report.motion.vel_rps.abs() <= STANDING_RPS => {
                Ok(report.motion.pos_rad)
            }
            Some(_) if is_ready => Err(NotStanding::Turns),
            _ => Err(NotStanding::Unknown),
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
            _ if self.said == Said::ReadFaults => Expected::FaultWord,
            _ => Expected::Report,
        }
    }

    fn on_report(&mut self, report: Report, ts_us: u64) {
        if let Some(last) = &self.report {
            let obeyed = self.obeyed.as_ref();
            self.frozen = self.freeze_watch.is_frozen(last, &report, obeyed, ts_us);
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
                    Status::Working => self.said == Said::Enable,
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
                    // Its supply may have failed for a moment, and taken the settings with it.
                    self.set_up(self.mode);
                }
            }
            Phase::Disabled | Phase::Fault => {}
        }
    }

    /// `code` 0: a fault that the motor has not named yet.
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

    /// The frame of this slot. `None` as command: no torque, before anything else.
    fn next_frame(
        &mut self,
        command: Option<&JointCommand>,
        config: &JointConfig,
        now_us: u64,
    ) -> CanFrame {
        self.said = Said::Other;
        self.sent = JointCommand::default();
        self.obeyed = None;
        let has_torque = matches!(self.phase, Phase::Enabling | Phase::Enabled { .. });
        if command.is_none() && has_torque {
            self.phase = Phase::Disabled;
            return self.slot.motor.disable();
        }
        if let Some(frame) = self.upkeep(now_us) {
            return frame;
        }
        match command {
            Some(command) => self.obey(command, config, now_us),
            None => self.slot.motor.disable(),
        }
    }

    /// What comes before commands: clearing, set-up, a look at the fault word.
    fn upkeep(&mut self, now_us: u64) -> Option<CanFrame> {
        let motor = &self.slot.motor;
        if core::mem::take(&mut self.clear_wanted) {
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
        let frame = motor.read_faults()?;
        self.said = Said::ReadFaults;
        Some(frame)
    }

    fn obey(&mut self, command: &JointCommand, config: &JointConfig, now_us: u64) -> CanFrame {
        if self.changes_mode(command.mode) {
            return self.slot.motor.disable();
        }
        match self.phase {
            Phase::Enabled { .. } => self.command_frame(command, config),
            Phase::Disabled | Phase::Enabling => self.enable_frame(now_us),
            Phase::SettingUp(_) | Phase::Fault => self.slot.motor.disable(),
        }
    }

    /// A motor obeys one mode at a time and changes it while disabled. `Off` in another mode than MIT, which alone can
    /// carry a zero, is to be disabled.
    fn changes_mode(&mut self, wanted: JointMode) -> bool {
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
            self.said = Said::Enable;
            self.slot.motor.enable()
        } else {
            self.slot.motor.disable()
        }
    }

    fn command_frame(&mut self, command: &JointCommand, config: &JointConfig) -> CanFrame {
        let period_s = self.slot.schedule.period_s();
        let limits = MotorLimits {
            max_torque_nm: self.slot.max_torque_nm,
            // The report is up to one period old, or more after lost ones; the command is one when the next comes.
            horizon_s: period_s + scalar::max(period_s, self.age_us as f32 * 1e-6),
        };
        let allowed = match &self.report {
            Some(report) => {
                let motion = axis::joint_motion(&report.motion, config);
                limited(command, motion, config, limits)
            }
            None => JointCommand::default(),
        };
        self.sent = allowed;
        let targets = axis::motor_targets(&allowed, config);
        self.obeyed = (allowed.mode == JointMode::Mit).then_some(targets);
        if allowed.mode == JointMode::Off && self.mode != JointMode::Mit {
            // The command was no number: the same as Off.
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
    /// A frame, if the motor has its slot in this tick.
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

    fn watch(&mut self, timeout_us: u32, now_us: u64) {
        self.age_us = age_us(self.report_ts_us, now_us);
        self.is_silent = self.age_us > timeout_us;
        if !self.is_silent {
            return;
        }
        self.freeze_watch.restart(now_us);
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
            self.obeyed = None;
        }
        due.then(|| self.next_frame(permitted.then_some(command), config, now_us))
    }
}

#[cfg(test)]
mod tests;
