//! Handles requests over CAN or the PC link, and their replies.

use super::{ControlLoop, heading_source};
use crate::{
    control::ChassisController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame},
    motor::layout::REPLY_PERIOD_TICKS,
    safety::ArmingState,
    tuning::{TuningAccess, TuningGate, TuningPort, is_request},
};

impl<C: ChassisController> ControlLoop<C> {
    /// Kept out of line and apart from the code for motor frames, as other frames are rare.
    #[cold]
    #[inline(never)]
    pub(super) fn on_other_frame(
        &mut self,
        bus: BusId,
        frame: &CanFrame,
        now_us: u64,
        diagnostics: &DiagnosticsSnapshot,
    ) {
        if is_request(frame) {
            self.on_request(TuningPort::Bus(bus), frame, now_us, diagnostics);
        } else {
            self.state.strangers.count(bus, frame.id());
        }
    }

    pub(super) fn on_request(
        &mut self,
        port: TuningPort,
        frame: &CanFrame,
        now_us: u64,
        diagnostics: &DiagnosticsSnapshot,
    ) {
        let gate = self.gate();
        let Self {
            tuning,
            config,
            bring_up,
            motors,
            state,
            ..
        } = self;
        let before = (config.mounting, tuning.status().revision);
        let access = TuningAccess {
            config,
            bring_up,
            sensors: &state.sensors,
            diagnostics,
            stationary_angle_rad: &|joint| motors.stationary_angle_rad(joint),
        };
        // The channel returns at most one reply for each port and slot.
        match (port, tuning.on_frame(port, frame, gate, access)) {
            (TuningPort::Bus(bus), Some(reply)) => {
                let _ = self.replies.push((bus, reply));
            }
            (TuningPort::Link, Some(reply)) => self.link_reply = Some(reply),
            (_, None) => {}
        }
        let (mounting, revision) = before;
        if self.config.mounting != mounting {
            let source = heading_source(&self.config.mounting);
            self.estimator
                .restart(&self.config.wheel_odom, source, now_us);
        }
        if self.tuning.status().revision != revision {
            self.apply_config(now_us);
        }
    }

    /// Applies changed settings. The estimator converts them once; all other stages read them in each tick.
    fn apply_config(&mut self, now_us: u64) {
        self.estimator.set_odometry(&self.config.wheel_odom);
        self.centred_sticks.restart();
        self.arming.settings_changed(now_us);
        self.policy.settings_changed(now_us);
    }

    pub(super) fn reply(&mut self) {
        self.link_frames.clear();
        if !self.state.stats.count.is_multiple_of(REPLY_PERIOD_TICKS) {
            if self.tuning.recorder().is_running() {
                self.send_recorded();
            } else if self.tuning.block().is_running() {
                self.send_block();
            }
            return;
        }
        // By the layout, motors take two of three mailboxes and a reply the third.
        let _ = self.frames.extend_from_slice(&self.replies);
        self.replies.clear();
        self.link_frames.extend(self.link_reply.take());
        self.tuning.begin_slot();
    }

    /// Kept out of line, as recordings are rare.
    #[cold]
    #[inline(never)]
    fn send_recorded(&mut self) {
        let gate = self.gate();
        // By the layout, motors take two of three mailboxes, and no reply is sent in this tick.
        let next = self.tuning.recorder().next(gate, &self.state.sensors);
        self.send_on_port(next);
    }

    /// Kept out of line, as the black box is rarely read.
    #[cold]
    #[inline(never)]
    fn send_block(&mut self) {
        let next = match self.black_box {
            Some(memory) if self.state.arming.state == ArmingState::Disarmed => {
                self.tuning.block().next(memory)
            }
            _ => {
                self.tuning.block().stop();
                None
            }
        };
        self.send_on_port(next);
    }

    fn send_on_port(&mut self, frame: Option<(TuningPort, CanFrame)>) {
        match frame {
            Some((TuningPort::Bus(bus), frame)) => self.frames.extend(Some((bus, frame))),
            Some((TuningPort::Link, frame)) => self.link_frames.extend(Some(frame)),
            None => {}
        }
    }

    fn gate(&self) -> TuningGate {
        TuningGate::of(self.state.arming.state, &self.state.operator)
    }
}
