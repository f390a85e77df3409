//! All stages in the order in which data flows.

use heapless::Vec;

use crate::{
    control::{ChassisController, ChassisControllerInput, UserController},
    diagnostics::{DiagnosticsSnapshot, TickStats},
    domain::{
        BusId, CanFrame, ChassisCommand, HighLevelCommand, ImuState, MagState, RemoteUpdate,
        RobotConfig, SensorsSnapshot, StateEstimate, SystemHealth, age_us,
    },
    estimation::InsEstimator,
    logic::LogicBus,
    motor::{
        MotorManager,
        layout::{MotorLayout, ROBOT_LAYOUT},
    },
    safety::{Arming, ArmingInputs, SafetyInputs, SafetyPolicy, TorquePermit},
};

/// The latest snapshot of each producer.
#[derive(Clone, Copy, Debug)]
pub struct ControlInputs<'a> {
    pub remote: &'a RemoteUpdate,
    pub imu: &'a ImuState,
    pub mag: &'a MagState,
    pub logic: &'a LogicBus,
    pub health: &'a SystemHealth,
}

/// What one tick produced.
#[derive(Clone, Copy, Debug)]
pub struct ControlOutputs<'a> {
    /// To be sent now, or never: the next tick brings newer ones.
    pub frames: &'a [(BusId, CanFrame)],
    pub sensors: &'a SensorsSnapshot,
    pub estimate: &'a StateEstimate,
    pub diagnostics: &'a DiagnosticsSnapshot,
}

/// Who decides the currents of this tick.
enum Demand {
    /// Nobody: no motor may move, or no command is fresh and valid.
    Stop,
    /// The logic bus, past the controller.
    Direct(ChassisCommand),
    Control(HighLevelCommand),
}

/// What no command reaches in this tick.
struct Stopped {
    wheels: bool,
    joints: bool,
}

/// State of all stages of the tick. Same calls, same results, bit for bit.
#[derive(Clone, Debug)]
pub struct ControlLoop<C: ChassisController = UserController> {
    config: RobotConfig,
    controller: C,
    motors: MotorManager,
    estimator: InsEstimator,
    policy: SafetyPolicy,
    arming: Arming,
    tick: TickStats,
    sensors: SensorsSnapshot,
    diagnostics: DiagnosticsSnapshot,
    frames: Vec<(BusId, CanFrame), 8>,
}

impl<C: ChassisController> ControlLoop<C> {
    /// For the robot with DM4310 joints.
    pub fn new(config: RobotConfig, controller: C) -> Self {
        Self::with_layout(&ROBOT_LAYOUT, config, controller)
    }

    pub fn with_layout(layout: &'static MotorLayout, config: RobotConfig, controller: C) -> Self {
        Self {
            config,
            controller,
            motors: MotorManager::new(layout),
            estimator: InsEstimator::new(config.wheel_odom),
            policy: SafetyPolicy::default(),
            arming: Arming::default(),
            tick: TickStats::default(),
            sensors: SensorsSnapshot::default(),
            diagnostics: DiagnosticsSnapshot::default(),
            frames: Vec::new(),
        }
    }

    /// Every frame received since the last tick, in order of arrival.
    pub fn on_can_frame(&mut self, bus: BusId, frame: &CanFrame, now_us: u64) {
        self.motors.route_frame(bus, frame, now_us);
    }

    /// One tick; `now_us` is when it began.
    pub fn tick(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> ControlOutputs<'_> {
        self.tick.tick(now_us);
        self.sense(inputs, now_us);
        let permit = self.judge(inputs, now_us);
        self.act(inputs, permit.as_ref(), now_us);
        self.record(inputs, now_us);
        ControlOutputs {
            frames: &self.frames,
            sensors: &self.sensors,
            estimate: &self.diagnostics.estimate,
            diagnostics: &self.diagnostics,
        }
    }

    fn sense(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let sensors = &mut self.sensors;
        sensors.imu = *inputs.imu;
        sensors.mag = *inputs.mag;
        sensors.motor = *self.motors.feedback(&self.config, now_us);
        sensors.ts_us = now_us;
        self.diagnostics.estimate =
            *self
                .estimator
                .step(&sensors.imu, &sensors.mag, &sensors.motor, now_us);
    }

    fn judge(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> Option<TorquePermit> {
        let diagnostics = &mut self.diagnostics;
        diagnostics.remote_diag = inputs.remote.diagnostics.at(now_us);
        diagnostics.safety = self.policy.evaluate(
            &SafetyInputs {
                config: &self.config.safety,
                remote: &diagnostics.remote_diag,
                operator: &inputs.remote.operator,
                imu_ts_us: inputs.imu.ts_us,
                estimate: &diagnostics.estimate,
                motor: &self.sensors.motor,
                motor_timeout_us: self.config.wheel_ctrl.feedback_timeout_us,
                command_ts_us: inputs.logic.ts_us,
                health: inputs.health,
            },
            now_us,
        );
        let (status, token) = self.arming.step(
            &ArmingInputs {
                config: &self.config.safety,
                remote: &inputs.remote.state,
                remote_age_us: diagnostics.remote_diag.age_us,
                operator: &inputs.remote.operator,
                estimate_valid: diagnostics.estimate.valid,
                calibrated: inputs.health.imu_calibrated,
                motor: &self.sensors.motor,
                read_only: false,
                safety: &diagnostics.safety,
            },
            now_us,
        );
        diagnostics.arming = status;
        token.map(|token| TorquePermit::new(token, &diagnostics.safety))
    }

    fn act(&mut self, inputs: &ControlInputs<'_>, permit: Option<&TorquePermit>, now_us: u64) {
        let stopped = Stopped {
            wheels: !self.motors.wheels_may_move(permit),
            joints: !self.motors.joints_may_move(permit),
        };
        let demand = if stopped.wheels && stopped.joints {
            Demand::Stop
        } else {
            self.demand(inputs.logic, now_us)
        };
        let wanted = match demand {
            Demand::Control(hl_cmd) => self.control(inputs, hl_cmd, &stopped),
            Demand::Direct(command) => {
                self.controller.reset();
                command
            }
            Demand::Stop => {
                self.controller.reset();
                ChassisCommand::default()
            }
        };
        if self.diagnostics.safety.clear_faults {
            self.motors.clear_faults();
        }
        let (frames, sent) = self.motors.compose(&wanted, permit, &self.config, now_us);
        self.frames.clear();
        // Room for twice as many.
        let _ = self.frames.extend_from_slice(&frames);
        self.diagnostics.command = sent;
    }

    fn demand(&self, logic: &LogicBus, now_us: u64) -> Demand {
        if age_us(logic.ts_us, now_us) > self.config.safety.command_timeout_us {
            Demand::Stop
        } else if logic.cmd_valid {
            Demand::Direct(logic.cmd)
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
    ) -> ChassisCommand {
        let output = self.controller.step(&ChassisControllerInput {
            sensors: &self.sensors,
            estimate: &self.diagnostics.estimate,
            wheel_odom_cfg: &self.config.wheel_odom,
            wheel_ctrl_cfg: &self.config.wheel_ctrl,
            joint_ctrl_cfg: &self.config.joint_ctrl,
            operator_state: &inputs.remote.operator,
            hl_cmd,
            wheels_stopped: stopped.wheels,
            joints_stopped: stopped.joints,
        });
        if output.cmd_valid {
            output.cmd
        } else {
            ChassisCommand::default()
        }
    }

    fn record(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let diagnostics = &mut self.diagnostics;
        let health = inputs.health;
        diagnostics.ts_us = now_us;
        diagnostics.remote = inputs.remote.state;
        diagnostics.operator = inputs.remote.operator;
        diagnostics.imu = self.sensors.imu;
        diagnostics.mag = self.sensors.mag;
        diagnostics.motor = self.sensors.motor;
        diagnostics.logic = *inputs.logic;
        diagnostics.can = health.can;
        diagnostics.imu_health = health.imu;
        diagnostics.mag_health = health.mag;
        diagnostics.radio_line = health.radio_line;
        diagnostics.imu_calibrated = health.imu_calibrated;
        diagnostics.imu_status = health.imu_status;
        diagnostics.tick = self.tick;
        diagnostics.late_tasks = health.late_tasks;
        diagnostics.reset_cause = health.reset_cause;
        diagnostics.last_words = health.last_words;
        diagnostics.battery_v = health.battery_v;
    }
}
