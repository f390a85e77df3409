//! Executes requests. In each slot there is at most one reply at a port.

use super::{
    BlockSender, LiveSource, PARAMETERS, ParameterGroup, Recorder, Refusal, TuningGate, TuningPort,
    bit, consistency, live, parameters,
    protocol::{self, Request, Restored},
    wheel_geometry::WheelGeometry,
};
use crate::{
    bring_up::BringUp,
    diagnostics::DiagnosticsSnapshot,
    domain::{BankState, BankStatus, CanFrame, RobotConfig, SensorsSnapshot, TuningStatus},
    motor::{NotStationary, layout::MotorLayout},
    safety::ArmingState,
};

/// Where the motor of a joint stands, in its own coordinates; `None` if there is no such joint.
pub type StationaryAngle<'a> = &'a dyn Fn(usize) -> Option<Result<f32, NotStationary>>;

/// What requests read and change.
pub struct TuningAccess<'a> {
    /// The settings.
    pub config: &'a mut RobotConfig,
    /// Bring-up.
    pub bring_up: &'a mut BringUp,
    /// The newest measurements.
    pub sensors: &'a SensorsSnapshot,
    /// The report that live pages show.
    pub diagnostics: &'a DiagnosticsSnapshot,
    /// Source of stationary joint angles.
    pub stationary_angle_rad: StationaryAngle<'a>,
}

/// Executes tuning requests.
///
/// ```
/// use robot_app::{
///     bring_up::BringUp,
///     diagnostics::DiagnosticsSnapshot,
///     domain::{CanFrame, RobotConfig, SensorsSnapshot},
///     motor::layout::ROBOT_LAYOUT,
///     tuning::{READ_ID, REPLY_ID, TuningAccess, TuningChannel, TuningGate, TuningPort, opcode},
/// };
///
/// let mut channel = TuningChannel::new(&ROBOT_LAYOUT);
/// channel.begin_slot();
/// // Reading is allowed while the robot is armed too.
/// let request = CanFrame::from_payload(READ_ID, &[opcode::READ_GEOMETRY]).unwrap();
/// let access = TuningAccess {
///     config: &mut RobotConfig::default(),
///     bring_up: &mut BringUp::default(),
///     sensors: &SensorsSnapshot::default(),
///     diagnostics: &DiagnosticsSnapshot::default(),
///     stationary_angle_rad: &|_joint| None,
/// };
/// let reply = channel.on_frame(TuningPort::Link, &request, TuningGate::Shut, access).unwrap();
/// assert_eq!(reply.id(), REPLY_ID);
/// assert_eq!(reply.payload()[..2], [opcode::READ_GEOMETRY, 75], "a radius of 75 mm");
/// ```
#[derive(Clone, Debug)]
pub struct TuningChannel {
    /// Provides the defaults.
    layout: &'static MotorLayout,
    /// A reply has been made in this slot. Index = `TuningPort::index`.
    replied: [bool; TuningPort::COUNT],
    status: TuningStatus,
    recorder: Recorder,
    block: BlockSender,
}

impl TuningChannel {
    /// A channel for the robot with this layout.
    pub fn new(layout: &'static MotorLayout) -> Self {
        Self {
            layout,
            replied: [false; TuningPort::COUNT],
            status: TuningStatus::default(),
            recorder: Recorder::default(),
            block: BlockSender::default(),
        }
    }

    /// Begins a slot. Called every `motor::layout::REPLY_PERIOD_TICKS`, after the replies of the previous slot have
    /// been sent.
    pub fn begin_slot(&mut self) {
        self.replied = [false; TuningPort::COUNT];
    }

    /// Takes any received frame and returns the reply for the same port. A client that waits for each reply always
    /// gets one. If several requests arrive in one slot, only the first is executed, so replies never overload a port.
    pub fn on_frame(
        &mut self,
        port: TuningPort,
        frame: &CanFrame,
        gate: TuningGate,
        access: TuningAccess<'_>,
    ) -> Option<CanFrame> {
        let TuningAccess {
            config,
            bring_up,
            sensors,
            diagnostics,
            stationary_angle_rad,
        } = access;
        let params = &diagnostics.params;
        let request = Request::decode(frame)?;
        if core::mem::replace(self.replied.get_mut(port.index())?, true) {
            self.status.dropped = self.status.dropped.wrapping_add(1);
            return None;
        }
        let done = request.and_then(|request| match request {
            Request::ReadGeometry => {
                let geometry = WheelGeometry::of(&config.wheel_odom);
                Ok(protocol::geometry_reply(geometry))
            }
            Request::ReadParameter { group, index } => {
                let value = parameters::find(group, index)?.read(config);
                Ok(protocol::parameter_reply(group, index, value))
            }
            Request::ReadStore => Ok(protocol::store_reply(params, self.status.revision)),
            Request::ReadFindings => Ok(protocol::findings_reply(params)),
            Request::ReadLive(page) => {
                let layout = self.layout;
                let source = LiveSource {
                    diagnostics,
                    layout,
                };
                live::read(page, &source).map(|bytes| protocol::live_reply(page, bytes))
            }
            Request::ReadRecording => Ok(protocol::recording_reply(self.recorder.status())),
            Request::ReadBlackBox(bank) => {
                let status = bank_status(diagnostics, bank)?;
                let overwritten = diagnostics.black_box.overwritten;
                Ok(protocol::black_box_reply(bank, status, overwritten))
            }
            Request::ReadBlock { bank, at, frames } => {
                find_event(diagnostics, bank)?;
                if self.recorder.is_running() {
                    return Err(Refusal::Recording);
                }
                self.block.start(port, bank, at, frames);
                Ok(protocol::echo(frame))
            }
            Request::ReleaseEvent { bank, number } => self
                .release_event(diagnostics, bank, number)
                .map(|()| protocol::echo(frame)),
            _ if gate == TuningGate::Shut => Err(Refusal::Armed),
            Request::WriteGeometry(geometry) => self
                .change(config, |candidate| geometry.apply(candidate))
                .map(|()| protocol::echo(frame)),
            Request::WriteParameter {
                group,
                index,
                value,
            } => {
                let parameter = parameters::find(group, index)?;
                self.change(config, |candidate| parameter.write(candidate, value))
                    .map(|()| protocol::echo(frame))
            }
            Request::RestoreDefaults(restored) => self
                .restore(config, restored)
                .map(|()| protocol::echo(frame)),
            Request::BringUp(request) => {
                bring_up.request(request);
                Ok(protocol::echo(frame))
            }
            Request::ZeroJoint { joint, angle_rad } => {
                let standing = stationary_angle_rad(joint.into());
                let motor_rad = standing.ok_or(Refusal::UnknownParameter)??;
                self.zero_joint(config, joint, motor_rad, angle_rad)
                    .map(|()| protocol::echo(frame))
            }
            Request::Record(seconds) => {
                self.recorder.start(port, seconds, sensors);
                Ok(protocol::echo(frame))
            }
        });
        Some(self.finish(frame, done))
    }

    /// The recorder of sensor samples.
    pub fn recorder(&mut self) -> &mut Recorder {
        &mut self.recorder
    }

    /// The sender of the black box.
    pub fn block(&mut self) -> &mut BlockSender {
        &mut self.block
    }

    /// Counters for diagnostics.
    pub fn status(&self) -> &TuningStatus {
        &self.status
    }

    /// Applies a change as a whole. If any part of it is refused, nothing changes.
    #[inline(never)]
    fn change(
        &mut self,
        config: &mut RobotConfig,
        apply: impl FnOnce(&mut RobotConfig) -> Result<(), Refusal>,
    ) -> Result<(), Refusal> {
        let mut candidate = *config;
        apply(&mut candidate)?;
        self.adopt(config, &candidate, 0)
    }

    /// Moves the zero of a joint, by joint angle = direction · (motor angle − zero).
    #[inline(never)]
    fn zero_joint(
        &mut self,
        config: &mut RobotConfig,
        joint: u8,
        motor_rad: f32,
        angle_rad: f32,
    ) -> Result<(), Refusal> {
        let parameter = parameters::joint_zero(joint)?;
        if angle_rad < parameter.min || angle_rad > parameter.max {
            return Err(Refusal::OutOfRange);
        }
        self.change(config, |candidate| {
            let joint = candidate.joints.get(usize::from(joint));
            let direction = joint.ok_or(Refusal::UnknownParameter)?.direction;
            parameter.write(candidate, motor_rad - direction * angle_rad)
        })
    }

    #[inline(never)]
    fn restore(&mut self, config: &mut RobotConfig, wanted: Restored) -> Result<(), Refusal> {
        let defaults = self.layout.default_config();
        let mut candidate = *config;
        let mut restored = 0;
        for (position, group) in PARAMETERS.iter().enumerate() {
            if wanted.covers(group) {
                group.copy(&defaults, &mut candidate);
                restored |= bit(position);
            }
        }
        if restored == 0 {
            return Err(Refusal::UnknownParameter);
        }
        self.adopt(config, &candidate, restored)
    }

    fn adopt(
        &mut self,
        config: &mut RobotConfig,
        candidate: &RobotConfig,
        restored: u32,
    ) -> Result<(), Refusal> {
        consistency::check(candidate)?;
        consistency::check_reorientation(config, candidate)?;
        let is_same = |group: &ParameterGroup| group.is_same(config, candidate);
        let restored = self.status.restored | restored;
        if restored != self.status.restored || !PARAMETERS.iter().all(is_same) {
            *config = *candidate;
            self.status.restored = restored;
            self.status.revision = self.status.revision.wrapping_add(1);
        }
        Ok(())
    }

    /// It changes no setting, so the enable switch may be on.
    fn release_event(
        &mut self,
        diagnostics: &DiagnosticsSnapshot,
        bank: u8,
        number: u16,
    ) -> Result<(), Refusal> {
        let event = find_event(diagnostics, bank)?;
        if event.number != number {
            return Err(Refusal::OutOfRange);
        }
        let mut released = self.status.black_box_released.iter_mut();
        if let Some(released) = released.nth(bank.into()) {
            *released = number;
        }
        Ok(())
    }

    fn finish(&mut self, request: &CanFrame, done: Result<CanFrame, Refusal>) -> CanFrame {
        let status = &mut self.status;
        match done {
            Ok(reply) => {
                status.accepted = status.accepted.wrapping_add(1);
                reply
            }
            Err(reason) => {
                status.refused = status.refused.wrapping_add(1);
                status.last_refusal = reason.code();
                protocol::refusal_reply(request, reason)
            }
        }
    }
}

fn bank_status(diagnostics: &DiagnosticsSnapshot, bank: u8) -> Result<&BankStatus, Refusal> {
    let status = diagnostics.black_box.banks.get(usize::from(bank));
    status.ok_or(Refusal::UnknownParameter)
}

/// The event in a bank. An armed robot may overwrite it at any time, so it is not read then.
fn find_event(diagnostics: &DiagnosticsSnapshot, bank: u8) -> Result<&BankStatus, Refusal> {
    let status = bank_status(diagnostics, bank)?;
    if diagnostics.arming.state == ArmingState::Armed {
        return Err(Refusal::Armed);
    }
    if status.state == BankState::Event {
        Ok(status)
    } else {
        Err(Refusal::OutOfRange)
    }
}

#[cfg(test)]
mod tests;
