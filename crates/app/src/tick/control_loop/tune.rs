//! Requests over CAN and their answers.

use super::{ControlLoop, heading_source};
use crate::{
    control::ChassisController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame},
    motor::layout::REPLY_PERIOD_TICKS,
    tuning::{TuningAccess, TuningGate, is_request},
};

impl<C: ChassisController> ControlLoop<C> {
    /// Rare, and never mixed into the code that runs for the frames of motors.
    #[cold]
    #[inline(never)]
    pub(super) fn on_other_frame(
        &mut self,
        bus: BusId,
        frame: &CanFrame,
        now_us: u64,
        diagnostics: &DiagnosticsSnapshot,
    ) {
        if !is_request(frame) {
            return self.state.strangers.note(bus, frame.id());
        }
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
        if let Some(reply) = tuning.on_frame(bus, frame, gate, access) {
            // The channel gives one a bus and tick.
            let _ = self.replies.push((bus, reply));
        }
        let (mounting, revision) = before;
        if self.config.mounting != mounting {
            let source = heading_source(&self.config.mounting);
            self.estimator
                .restart(&self.config.wheel_odom, source, now_us);
        }
        if self.tuning.status().revision != revision {
            self.take_config(now_us);
        }
    }

    /// Settings have changed. The estimator keeps what it makes of its own; all other stages read them in each tick.
    fn take_config(&mut self, now_us: u64) {
        self.estimator.set_odometry(&self.config.wheel_odom);
        self.centred_sticks.restart();
        self.arming.settings_changed(now_us);
    }

    pub(super) fn reply(&mut self) {
        if !self.state.stats.count.is_multiple_of(REPLY_PERIOD_TICKS) {
            if self.tuning.recorder().is_running() {
                self.send_recorded();
            }
            return;
        }
        // Motors take two of three mailboxes (layout), a reply the third.
        let _ = self.frames.extend_from_slice(&self.replies);
        self.replies.clear();
        self.tuning.begin_slot();
    }

    /// Rare.
    #[cold]
    #[inline(never)]
    fn send_recorded(&mut self) {
        let gate = self.gate();
        // Motors take two of three mailboxes (layout), and no reply goes out in this tick.
        self.frames
            .extend(self.tuning.recorder().next(gate, &self.state.sensors));
    }

    fn gate(&self) -> TuningGate {
        TuningGate::of(self.state.arming.state, &self.state.operator)
    }
}
