//! All stages in the order in which data flows.

mod act;
mod judge;
mod record;
mod tune;

use heapless::Vec;

use super::{ControlInputs, ControlOutputs, TickState};
use crate::{
    bring_up::{BringUp, BringUpInputs},
    control::{ChassisController, UserController},
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame, ChassisCommand, MountingConfig, RobotConfig, age_us},
    estimation::{HeadingSource, InsEstimator},
    motor::{
        MotorManager, TickFrames,
        layout::{MotorLayout, ROBOT_LAYOUT},
    },
    safety::{Arming, AttitudeSettling, CentredSticks, FlashPermit, SafetyPolicy},
    tuning::TuningChannel,
};

/// Ticks between two looks at what changes slowly or interests only who watches: that part of the diagnostics is
/// renewed in the ticks whose count is a multiple of this.
pub const DIAGNOSTICS_PERIOD_TICKS: u32 = 10;

/// In which of them sticks and motors are looked at: not the one in which diagnostics are renewed.
const LOOK_PHASE: u32 = 5;

/// A magnetometer that sits nobody knows how shows nothing.
fn heading_source(mounting: &MountingConfig) -> HeadingSource {
    match mounting.mag {
        Some(_) => HeadingSource::Magnetometer,
        None => HeadingSource::GyroOnly,
    }
}

/// State of all stages of the tick. Same calls, same results, bit for bit.
#[derive(Clone, Debug)]
pub struct ControlLoop<C: ChassisController = UserController> {
    config: RobotConfig,
    controller: C,
    motors: MotorManager,
    /// See `MotorLayout::needs_manual_timeout`.
    timeout_by_hand: bool,
    estimator: InsEstimator,
    policy: SafetyPolicy,
    /// Of the period in which diagnostics are renewed.
    phase: u32,
    centred_sticks: CentredSticks,
    attitude_settling: AttitudeSettling,
    arming: Arming,
    flash: FlashPermit,
    tuning: TuningChannel,
    /// Of the tuning channel, for its next slot: one a bus.
    replies: Vec<(BusId, CanFrame), 2>,
    bring_up: BringUp,
    state: TickState,
    frames: TickFrames,
}

impl<C: ChassisController> ControlLoop<C> {
    /// For the robot with DM4310 joints.
    pub fn new(config: RobotConfig, controller: C) -> Self {
        Self::with_layout(&ROBOT_LAYOUT, config, controller)
    }

    pub fn with_layout(layout: &'static MotorLayout, config: RobotConfig, controller: C) -> Self {
        let mut estimator = InsEstimator::new(config.wheel_odom);
        estimator.set_heading_source(heading_source(&config.mounting));
        Self {
            config,
            controller,
            motors: MotorManager::new(layout),
            timeout_by_hand: layout.needs_manual_timeout(),
            estimator,
            policy: SafetyPolicy::default(),
            phase: 0,
            centred_sticks: CentredSticks::default(),
            attitude_settling: AttitudeSettling::default(),
            arming: Arming::default(),
            flash: FlashPermit::default(),
            tuning: TuningChannel::new(layout),
            replies: Vec::new(),
            bring_up: BringUp::default(),
            state: TickState::default(),
            frames: TickFrames::new(),
        }
    }

    /// Every frame received since the last tick, in order of arrival. `diagnostics` is the report of the last tick, for
    /// who asks for it over CAN.
    pub fn on_can_frame(
        &mut self,
        bus: BusId,
        frame: &CanFrame,
        now_us: u64,
        diagnostics: &DiagnosticsSnapshot,
    ) {
        if !self.motors.route_frame(bus, frame, now_us) {
            self.on_other_frame(bus, frame, now_us, diagnostics);
        }
    }

    /// Before the first tick after the whole chip stood still for `stall_us` (a flash erase): nobody else is to blame
    /// for what did not happen meanwhile.
    #[cold]
    #[inline(never)]
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        self.state.stats.stalled(stall_us);
        self.motors.after_stall(stall_us, now_us);
        self.centred_sticks.after_stall(now_us);
    }

    /// One tick; `now_us` is when it began. Writes its report into `diagnostics`, always the same one, and reads nothing
    /// in it.
    pub fn tick<'a>(
        &'a mut self,
        inputs: &ControlInputs<'_>,
        now_us: u64,
        diagnostics: &'a mut DiagnosticsSnapshot,
    ) -> ControlOutputs<'a> {
        let stats = &mut self.state.stats;
        stats.tick(now_us);
        self.phase = stats.count % DIAGNOSTICS_PERIOD_TICKS;
        self.sense(inputs, now_us);
        let trial = self.try_out(inputs, now_us);
        self.guard_flash(inputs, now_us);
        if self.phase == LOOK_PHASE {
            self.look_at_what_must_rest(inputs, now_us);
        }
        let permit = self.judge(inputs, now_us);
        self.act(inputs, permit.as_ref(), trial.as_ref(), now_us);
        self.reply();
        self.record(inputs, now_us, diagnostics);
        ControlOutputs {
            frames: &self.frames,
            estimate: &self.state.estimate,
            diagnostics,
            config: &self.config,
            flash: self.flash.grant(),
        }
    }

    fn sense(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let TickState {
            sensors,
            estimate,
            operator,
            ..
        } = &mut self.state;
        *operator = inputs.remote.operator;
        if sensors.imu.ts_us != inputs.imu.ts_us {
            sensors.imu = *inputs.imu;
        }
        if sensors.mag.ts_us != inputs.mag.ts_us {
            sensors.mag = *inputs.mag;
        }
        self.motors
            .feedback(&self.config, now_us, &mut sensors.motor);
        sensors.ts_us = now_us;
        let (imu, mag) = (&sensors.imu, &sensors.mag);
        self.estimator
            .step(imu, mag, &sensors.motor, now_us, estimate);
    }

    /// The command of bring-up, which replaces any other.
    fn try_out(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> Option<ChassisCommand> {
        let state = &mut self.state;
        let link = &inputs.remote.diagnostics;
        let known = &state.link;
        let news = known.frames != link.frames || known.frame_ts_us != link.frame_ts_us;
        if news || self.phase == 0 {
            state.link = link.at(now_us);
        } else {
            // The rate falls slowly; the age stops the robot.
            state.link.age_us = age_us(link.good_ts_us, now_us);
        }
        self.bring_up.step(
            &BringUpInputs {
                remote: &inputs.remote.state,
                operator: &inputs.remote.operator,
                remote_age_us: state.link.age_us,
                arming: state.arming.state,
                motor: &state.sensors.motor,
                wheel_odom: &self.config.wheel_odom,
            },
            now_us,
        )
    }
}

#[cfg(test)]
mod tests;
