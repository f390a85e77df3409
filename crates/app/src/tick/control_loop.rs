//! All stages in the order in which data flows.

use core::borrow::BorrowMut;

use heapless::Vec;

use crate::{
    bring_up::{BringUp, BringUpInputs},
    control::{ChassisController, ChassisControllerInput, ChassisControllerOutput, UserController},
    diagnostics::DiagnosticsSnapshot,
    domain::{
        BusId, CanFrame, ChassisCommand, FlashRequest, HighLevelCommand, ImuState, LogicBus,
        MagState, MountingConfig, ParamStatus, RemoteUpdate, RobotConfig, StateEstimate,
        SystemHealth, age_us,
    },
    estimation::{HeadingSource, InsEstimator},
    motor::{
        MotorManager, TickFrames,
        layout::{MotorLayout, REPLY_PERIOD_TICKS, ROBOT_LAYOUT},
    },
    safety::{
        Arming, ArmingInputs, ArmingState, AttitudeSettling, CentredSticks, FlashGrant,
        FlashPermit, FlashPermitInputs, MotorReadiness, SafetyInputs, SafetyPolicy, TorquePermit,
        WatchdogPeriod,
    },
    tuning::{TuningAccess, TuningChannel, TuningGate, is_request},
};

/// Ticks between two looks at what changes slowly or interests only who watches: that part of the diagnostics is
/// renewed in the ticks whose count is a multiple of this.
pub const DIAGNOSTICS_PERIOD_TICKS: u32 = 10;

/// In which of them sticks and motors are looked at: not the one in which diagnostics are renewed.
const LOOK_PHASE: u32 = 5;

/// The latest snapshot of each producer.
#[derive(Clone, Copy, Debug)]
pub struct ControlInputs<'a> {
    pub remote: &'a RemoteUpdate,
    pub imu: &'a ImuState,
    pub mag: &'a MagState,
    pub logic: &'a LogicBus,
    pub health: &'a SystemHealth,
    pub params: &'a ParamStatus,
    /// What the parameter store would do to flash.
    pub flash_request: FlashRequest,
    pub watchdog: WatchdogPeriod,
}

/// What one tick produced.
#[derive(Clone, Copy, Debug)]
pub struct ControlOutputs<'a> {
    /// To be sent now, or never: the next tick brings newer ones.
    pub frames: &'a [(BusId, CanFrame)],
    pub estimate: &'a StateEstimate,
    pub diagnostics: &'a DiagnosticsSnapshot,
    /// As `diagnostics.tuning.revision` counts it.
    pub config: &'a RobotConfig,
    pub flash: FlashGrant,
}

/// Who decides the commands of this tick.
enum Demand<'a> {
    /// Nobody: no motor may move, or no command is fresh and valid.
    Stop,
    /// The logic bus or bring-up, past the controller.
    Direct(&'a ChassisCommand),
    Control(HighLevelCommand),
}

/// A magnetometer that sits nobody knows how shows nothing.
fn heading_source(mounting: &MountingConfig) -> HeadingSource {
    match mounting.mag {
        Some(_) => HeadingSource::Magnetometer,
        None => HeadingSource::GyroOnly,
    }
}

/// What no command reaches in this tick.
struct Stopped {
    wheels: bool,
    joints: bool,
}

/// State of all stages of the tick. Same calls, same results, bit for bit.
///
/// `D` is where the diagnostics are kept: in here, or in a place of the caller's that a debugger knows.
#[derive(Clone, Debug)]
pub struct ControlLoop<
    C: ChassisController = UserController,
    D: BorrowMut<DiagnosticsSnapshot> = DiagnosticsSnapshot,
> {
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
    sticks_centred: bool,
    attitude_settling: AttitudeSettling,
    attitude_settled: bool,
    arming: Arming,
    flash: FlashPermit,
    tuning: TuningChannel,
    /// Of the tuning channel, for its next slot: one a bus.
    replies: Vec<(BusId, CanFrame), 2>,
    bring_up: BringUp,
    diagnostics: D,
    frames: TickFrames,
}

impl<C: ChassisController> ControlLoop<C> {
    /// For the robot with DM4310 joints.
    pub fn new(config: RobotConfig, controller: C) -> Self {
        Self::with_layout(&ROBOT_LAYOUT, config, controller)
    }

    pub fn with_layout(layout: &'static MotorLayout, config: RobotConfig, controller: C) -> Self {
        Self::with_diagnostics(layout, config, controller, DiagnosticsSnapshot::default())
    }
}

impl<C: ChassisController, D: BorrowMut<DiagnosticsSnapshot>> ControlLoop<C, D> {
    pub fn with_diagnostics(
        layout: &'static MotorLayout,
        config: RobotConfig,
        controller: C,
        diagnostics: D,
    ) -> Self {
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
            sticks_centred: false,
            attitude_settling: AttitudeSettling::default(),
            attitude_settled: false,
            arming: Arming::default(),
            flash: FlashPermit::default(),
            tuning: TuningChannel::new(layout),
            replies: Vec::new(),
            bring_up: BringUp::default(),
            diagnostics,
            frames: TickFrames::new(),
        }
    }

    /// Every frame received since the last tick, in order of arrival.
    pub fn on_can_frame(&mut self, bus: BusId, frame: &CanFrame, now_us: u64) {
        if !self.motors.route_frame(bus, frame, now_us) {
            self.on_other_frame(bus, frame, now_us);
        }
    }

    /// Rare, and never mixed into the code that runs for the frames of motors.
    #[cold]
    #[inline(never)]
    fn on_other_frame(&mut self, bus: BusId, frame: &CanFrame, now_us: u64) {
        let diagnostics: &mut DiagnosticsSnapshot = self.diagnostics.borrow_mut();
        if !is_request(frame) {
            return diagnostics.strangers.note(bus, frame.id());
        }
        let gate = TuningGate::of(diagnostics.arming.state, &diagnostics.operator);
        let Self {
            tuning,
            config,
            bring_up,
            motors,
            ..
        } = self;
        let access = TuningAccess {
            config,
            bring_up,
            diagnostics,
            stationary_angle_rad: &|joint| motors.stationary_angle_rad(joint),
        };
        let mounting = access.config.mounting;
        if let Some(reply) = tuning.on_frame(bus, frame, gate, access) {
            // The channel gives one a bus and tick.
            let _ = self.replies.push((bus, reply));
        }
        let RobotConfig {
            mounting: wanted,
            wheel_odom,
            ..
        } = &self.config;
        if *wanted != mounting {
            self.estimator
                .restart(wheel_odom, heading_source(wanted), now_us);
        }
        self.take_config(now_us);
    }

    /// Before the first tick after the whole chip stood still for `stall_us` (a flash erase): nobody else is to blame
    /// for what did not happen meanwhile.
    #[cold]
    #[inline(never)]
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        self.diagnostics.borrow_mut().tick.stalled(stall_us);
        self.motors.after_stall(stall_us, now_us);
        self.centred_sticks.after_stall(now_us);
    }

    /// One tick; `now_us` is when it began.
    pub fn tick(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> ControlOutputs<'_> {
        let stats = &mut self.diagnostics.borrow_mut().tick;
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
        self.record(inputs, now_us);
        let diagnostics: &DiagnosticsSnapshot = self.diagnostics.borrow();
        ControlOutputs {
            frames: &self.frames,
            estimate: &diagnostics.estimate,
            diagnostics,
            config: &self.config,
            flash: self.flash.grant(),
        }
    }

    /// After a request. The estimator keeps what it makes of its settings; all other stages read them in each tick.
    fn take_config(&mut self, now_us: u64) {
        let diagnostics = self.diagnostics.borrow_mut();
        let status = *self.tuning.status();
        if status.revision != diagnostics.tuning.revision {
            self.estimator.set_odometry(&self.config.wheel_odom);
            self.centred_sticks.restart();
            self.arming.settings_changed(now_us);
        }
        diagnostics.tuning = status;
    }

    fn sense(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let DiagnosticsSnapshot {
            sensors, estimate, ..
        } = self.diagnostics.borrow_mut();
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
        let diagnostics = self.diagnostics.borrow_mut();
        let link = &inputs.remote.diagnostics;
        let known = &diagnostics.remote_diag;
        let news = known.frames != link.frames || known.frame_ts_us != link.frame_ts_us;
        if news || self.phase == 0 {
            diagnostics.remote_diag = link.at(now_us);
        } else {
            // The rate falls slowly; the age stops the robot.
            diagnostics.remote_diag.age_us = age_us(link.good_ts_us, now_us);
        }
        let command = self.bring_up.step(
            &BringUpInputs {
                remote: &inputs.remote.state,
                operator: &inputs.remote.operator,
                remote_age_us: diagnostics.remote_diag.age_us,
                arming: diagnostics.arming.state,
                motor: &diagnostics.sensors.motor,
                wheel_odom: &self.config.wheel_odom,
            },
            now_us,
        );
        diagnostics.bring_up = *self.bring_up.status();
        command
    }

    fn guard_flash(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        if inputs.flash_request != FlashRequest::None {
            return self.consider_flash(inputs, now_us);
        }
        let diagnostics: &DiagnosticsSnapshot = self.diagnostics.borrow();
        self.flash
            .idle(diagnostics.arming.state, inputs.watchdog, now_us);
    }

    /// Rare.
    #[cold]
    #[inline(never)]
    fn consider_flash(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let diagnostics: &DiagnosticsSnapshot = self.diagnostics.borrow();
        self.flash.step(
            &FlashPermitInputs {
                request: inputs.flash_request,
                watchdog: inputs.watchdog,
                arming: diagnostics.arming.state,
                enabled: inputs.remote.operator.enabled,
                tries_motors: self.bring_up.tries_motors(),
                motor: &diagnostics.sensors.motor,
                buses: &self.motors.layout().buses(),
                can: &inputs.health.can,
            },
            now_us,
        );
    }

    /// What arming looks at and need not be newer than some milliseconds.
    #[inline(never)]
    fn look_at_what_must_rest(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let diagnostics = self.diagnostics.borrow_mut();
        let config = &self.config;
        let fresh = diagnostics.remote_diag.age_us <= config.safety.remote_timeout_us;
        self.sticks_centred =
            self.centred_sticks
                .step(&inputs.remote.state, fresh, &config.safety, now_us);
        let rejects = &inputs.health.imu_status.rejects;
        self.attitude_settled = self.attitude_settling.step(rejects, now_us);
        if diagnostics.arming.state == ArmingState::Disarmed {
            diagnostics.motors = MotorReadiness::assess(&diagnostics.sensors.motor, &config.joints);
        }
    }

    fn judge(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> Option<TorquePermit> {
        let diagnostics = self.diagnostics.borrow_mut();
        diagnostics.safety = self.policy.evaluate(
            &SafetyInputs {
                config: &self.config.safety,
                remote: &diagnostics.remote_diag,
                operator: &inputs.remote.operator,
                may_resume: self.sticks_centred
                    || diagnostics.arming.state == ArmingState::Disarmed,
                imu_ts_us: inputs.imu.ts_us,
                estimate: &diagnostics.estimate,
                motor: &diagnostics.sensors.motor,
                motor_timeout_us: self.config.wheel_ctrl.feedback_timeout_us,
                command_ts_us: inputs.logic.ts_us,
                health: inputs.health,
            },
            now_us,
        );
        let (status, token) = self.arming.step(
            &ArmingInputs {
                config: &self.config.safety,
                sticks_centred: self.sticks_centred,
                attitude_settled: self.attitude_settled,
                remote_age_us: diagnostics.remote_diag.age_us,
                operator: &inputs.remote.operator,
                estimate_valid: diagnostics.estimate.valid,
                calibrated: inputs.health.imu_calibrated,
                motor: &diagnostics.motors,
                read_only: self.bring_up.blocks_arming(),
                tries_motors: self.bring_up.tries_motors(),
                flash_busy: self.flash.grant().blocks_arming,
                params: inputs.params,
                debugger_catches: inputs.health.debug_probe.catches,
                joint_timeout_unset: self.timeout_by_hand
                    && self.config.joint_ctrl.rs00_timeout_set == 0,
                safety: &diagnostics.safety,
            },
            now_us,
        );
        diagnostics.arming = status;
        token.map(|token| TorquePermit::new(token, &diagnostics.safety))
    }

    fn act(
        &mut self,
        inputs: &ControlInputs<'_>,
        permit: Option<&TorquePermit>,
        trial: Option<&ChassisCommand>,
        now_us: u64,
    ) {
        let stopped = Stopped {
            wheels: !self.motors.wheels_may_move(permit),
            joints: !self.motors.joints_may_move(permit),
        };
        let demand = if stopped.wheels && stopped.joints {
            Demand::Stop
        } else if let Some(command) = trial {
            Demand::Direct(command)
        } else {
            self.demand(inputs.logic, now_us)
        };
        let output;
        let wanted = match demand {
            Demand::Control(hl_cmd) => {
                output = self.control(inputs, hl_cmd, &stopped);
                if output.cmd_valid {
                    &output.cmd
                } else {
                    &ChassisCommand::STOP
                }
            }
            Demand::Direct(command) => {
                self.controller.reset();
                command
            }
            Demand::Stop => {
                self.controller.reset();
                &ChassisCommand::STOP
            }
        };
        let diagnostics = self.diagnostics.borrow_mut();
        if diagnostics.safety.clear_faults {
            self.motors.clear_faults();
        }
        self.frames.clear();
        self.motors.compose(
            wanted,
            permit,
            &self.config,
            now_us,
            &mut self.frames,
            &mut diagnostics.command,
        );
    }

    fn reply(&mut self) {
        let diagnostics: &DiagnosticsSnapshot = self.diagnostics.borrow();
        if !diagnostics.tick.count.is_multiple_of(REPLY_PERIOD_TICKS) {
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
        let diagnostics: &DiagnosticsSnapshot = self.diagnostics.borrow();
        let gate = TuningGate::of(diagnostics.arming.state, &diagnostics.operator);
        // Motors take two of three mailboxes (layout), and no reply goes out in this tick.
        self.frames
            .extend(self.tuning.recorder().next(gate, diagnostics));
    }

    fn demand<'a>(&self, logic: &'a LogicBus, now_us: u64) -> Demand<'a> {
        if age_us(logic.ts_us, now_us) > self.config.safety.command_timeout_us {
            Demand::Stop
        } else if logic.cmd_valid {
            Demand::Direct(&logic.cmd)
        } else if logic.hl_valid {
            Demand::Control(logic.hl_cmd)
        } else {
            Demand::Stop
        }
    }

    fn control(
        &mut self,
        inputs: &ControlInputs<'_>,
        hl_cmd: HighLevelCommand,
        stopped: &Stopped,
    ) -> ChassisControllerOutput {
        let diagnostics: &DiagnosticsSnapshot = self.diagnostics.borrow();
        self.controller.step(&ChassisControllerInput {
            sensors: &diagnostics.sensors,
            estimate: &diagnostics.estimate,
            wheel_odom_cfg: &self.config.wheel_odom,
            wheel_ctrl_cfg: &self.config.wheel_ctrl,
            joint_ctrl_cfg: &self.config.joint_ctrl,
            operator_state: &inputs.remote.operator,
            hl_cmd,
            wheels_stopped: stopped.wheels,
            joints_stopped: stopped.joints,
        })
    }

    fn record(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let diagnostics = self.diagnostics.borrow_mut();
        let health = inputs.health;
        diagnostics.ts_us = now_us;
        if diagnostics.remote.ts_us != inputs.remote.state.ts_us {
            diagnostics.remote = inputs.remote.state;
        }
        diagnostics.operator = inputs.remote.operator;
        if diagnostics.logic.ts_us != inputs.logic.ts_us {
            diagnostics.logic = *inputs.logic;
        }
        diagnostics.late_tasks = health.late_tasks;
        if self.phase != 0 {
            return;
        }
        diagnostics.remote_raw = inputs.remote.raw;
        diagnostics.can = health.can;
        diagnostics.imu_health = health.imu;
        diagnostics.mag_health = health.mag;
        diagnostics.radio_line = health.radio_line;
        diagnostics.imu_calibrated = health.imu_calibrated;
        diagnostics.imu_status = health.imu_status;
        diagnostics.reset_cause = health.reset_cause;
        diagnostics.tick.max_jitter_cycles = health.max_jitter_cycles;
        diagnostics.last_words = health.last_words;
        diagnostics.battery_v = health.battery_v;
        diagnostics.debug_probe = health.debug_probe;
        diagnostics.params = *inputs.params;
    }
}

#[cfg(test)]
mod tests;
