//! The control loop runs all stages in the order in which data flows.

mod act;
mod permit;
mod record;
mod telemetry;
mod tune;

use heapless::Vec;

use super::{ControlInputs, ControlOutputs, TickState};
use crate::{
    black_box::BlackBoxMemory,
    bring_up::{BringUp, BringUpInputs},
    control::{ChassisController, UserController},
    diagnostics::{DiagnosticsSnapshot, TELEMETRY_PERIOD_TICKS, Telemetry},
    domain::{
        BusId, CanFrame, ChassisCommand, JointFeedback, LegGeometry, MotorFeedback, MountingConfig,
        RobotConfig, RobotProfile, age_us,
    },
    estimation::{HeadingSource, InsEstimator},
    kinematics::Leg,
    motor::{
        MotorManager, TickFrames,
        layout::{MotorLayout, ROBOT_LAYOUT},
    },
    safety::{Arming, AttitudeSettling, CentredSticks, FlashPermit, SafetyPolicy},
    tuning::{TuningChannel, TuningPort, is_request},
};

/// Period of the slow part of diagnostics, in ticks: what changes slowly or only matters to an observer is updated
/// when the tick count is a multiple of it.
pub const DIAGNOSTICS_PERIOD_TICKS: u32 = 10;

/// The tick of this period in which sticks and motors are checked. It differs from the one that updates diagnostics.
const ARMING_CONDITIONS_PHASE: u32 = 5;

/// A magnetometer with an unknown mounting is not used.
fn heading_source(mounting: &MountingConfig) -> HeadingSource {
    match mounting.mag {
        Some(_) => HeadingSource::Magnetometer,
        None => HeadingSource::GyroOnly,
    }
}

/// Oldest report of a joint from which a leg is computed.
const MAX_JOINT_AGE_US: u32 = 20_000;

/// Both legs, if all joints report angles that fit the geometry.
fn known_legs(geometry: &LegGeometry, motor: &MotorFeedback) -> Option<[Leg; 2]> {
    let heard = |joint: &JointFeedback| joint.age_us <= MAX_JOINT_AGE_US && !joint.frozen;
    if !motor.joints.iter().all(heard) {
        return None;
    }
    let [left_front, left_rear, right_front, right_rear] = &motor.joints;
    let left = Leg::measured(geometry, left_front, left_rear);
    let right = Leg::measured(geometry, right_front, right_rear);
    (left.fits && right.fits).then_some([left, right])
}

/// State of all stages of the tick. The same calls give the same results, bit for bit.
///
/// ```
/// use robot_app::control::UserController;
/// use robot_app::diagnostics::DiagnosticsSnapshot;
/// use robot_app::domain::*;
/// use robot_app::motor::layout::ROBOT_LAYOUT;
/// use robot_app::safety::{ArmingState, WatchdogPeriod};
/// use robot_app::tick::{ControlInputs, ControlLoop};
///
/// let mut control = ControlLoop::new(ROBOT_LAYOUT.default_config(), UserController::default());
/// let mut diagnostics = DiagnosticsSnapshot::default();
/// let inputs = ControlInputs {
///     remote: &RemoteUpdate::default(),
///     imu: &ImuState::default(),
///     mag: &MagState::default(),
///     logic: &LogicBus::default(),
///     pc: &PcCommand::default(),
///     health: &SystemHealth::default(),
///     params: &ParamStatus::default(),
///     flash_request: FlashRequest::None,
///     watchdog: WatchdogPeriod::Short,
/// };
/// let outputs = control.tick(&inputs, 1_000, &mut diagnostics);
/// // Without radio and sensors nothing arms, and the wheels get zero current.
/// assert_eq!(outputs.diagnostics.arming.state, ArmingState::Disarmed);
/// let (bus, frame) = outputs.frames[0];
/// assert_eq!((bus, frame.id().raw(), frame.payload()), (BusId::Can1, 0x200, &[0; 8][..]));
/// ```
#[derive(Clone, Debug)]
pub struct ControlLoop<C: ChassisController = UserController> {
    profile: &'static RobotProfile,
    config: RobotConfig,
    controller: C,
    motors: MotorManager,
    /// See `MotorLayout::needs_manual_timeout`.
    timeout_by_hand: bool,
    legs: LegGeometry,
    estimator: InsEstimator,
    policy: SafetyPolicy,
    /// Tick within the period of slow diagnostics.
    phase: u32,
    centred_sticks: CentredSticks,
    attitude_settling: AttitudeSettling,
    arming: Arming,
    flash: FlashPermit,
    tuning: TuningChannel,
    /// What requests for the black box read; `None` on a robot without one.
    black_box: Option<&'static BlackBoxMemory>,
    /// Replies of the tuning channel for its next slot, one for each bus.
    replies: Vec<(BusId, CanFrame), 2>,
    /// The same for the PC link.
    link_reply: Option<CanFrame>,
    bring_up: BringUp,
    state: TickState,
    frames: TickFrames,
    /// At most a reply and a recorded sample.
    link_frames: Vec<CanFrame, 2>,
    telemetry: Telemetry,
}

impl<C: ChassisController> ControlLoop<C> {
    /// A loop for the robot with DM4310 joints.
    pub fn new(config: RobotConfig, controller: C) -> Self {
        Self::with_layout(&ROBOT_LAYOUT, config, controller)
    }

    /// A loop for the robot with this motor layout.
    pub fn with_layout(layout: &'static MotorLayout, config: RobotConfig, controller: C) -> Self {
        let mut estimator = InsEstimator::new(config.wheel_odom);
        estimator.set_heading_source(heading_source(&config.mounting));
        estimator.set_imu_height(layout.profile().imu_up_m);
        Self {
            profile: layout.profile(),
            config,
            controller,
            motors: MotorManager::new(layout),
            timeout_by_hand: layout.needs_manual_timeout(),
            legs: layout.profile().balance.legs,
            estimator,
            policy: SafetyPolicy::default(),
            phase: 0,
            centred_sticks: CentredSticks::default(),
            attitude_settling: AttitudeSettling::default(),
            arming: Arming::default(),
            flash: FlashPermit::default(),
            tuning: TuningChannel::new(layout),
            black_box: None,
            replies: Vec::new(),
            link_reply: None,
            bring_up: BringUp::default(),
            state: TickState::default(),
            frames: TickFrames::new(),
            link_frames: Vec::new(),
            telemetry: Telemetry::default(),
        }
    }

    /// Lets the tuning channel read this black box.
    pub fn set_black_box(&mut self, memory: &'static BlackBoxMemory) {
        self.black_box = Some(memory);
    }

    /// Takes a frame received since the last tick, in order of arrival. `diagnostics` is the report of the last tick,
    /// for requests over CAN.
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

    /// Takes a frame that came through the tunnel of the PC link. Only requests of the tuning channel count, under the
    /// rules that hold on a bus.
    #[cold]
    #[inline(never)]
    pub fn on_link_frame(
        &mut self,
        frame: &CanFrame,
        now_us: u64,
        diagnostics: &DiagnosticsSnapshot,
    ) {
        if is_request(frame) {
            self.on_request(TuningPort::Link, frame, now_us, diagnostics);
        }
    }

    /// Tells the stages that the whole chip stood still for `stall_us` (a flash erase), before the next tick. What
    /// did not happen meanwhile is no fault.
    #[cold]
    #[inline(never)]
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        self.state.stats.stalled(stall_us);
        self.motors.after_stall(stall_us, now_us);
        self.centred_sticks.after_stall(now_us);
    }

    /// Runs one tick, which began at `now_us`. It writes its report into `diagnostics`, always the same snapshot, and
    /// reads nothing from it.
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
        let trial = self.step_bring_up(inputs, now_us);
        self.update_flash_permit(inputs, now_us);
        if self.phase == ARMING_CONDITIONS_PHASE {
            self.update_arming_conditions(inputs, now_us);
        }
        let permit = self.decide_permit(inputs, trial.is_some(), now_us);
        self.act(inputs, permit.as_ref(), trial.as_ref(), now_us);
        self.reply();
        self.record(inputs, now_us, diagnostics);
        let brief = self.is_telemetry_tick();
        if brief {
            self.record_telemetry(now_us);
        }
        ControlOutputs {
            frames: &self.frames,
            link_frames: &self.link_frames,
            telemetry: brief.then_some(&self.telemetry),
            estimate: &self.state.estimate,
            diagnostics,
            config: &self.config,
            flash: self.flash.grant(),
        }
    }

    fn is_telemetry_tick(&self) -> bool {
        let count = self.state.stats.count;
        count.is_multiple_of(TELEMETRY_PERIOD_TICKS)
    }

    fn sense(&mut self, inputs: &ControlInputs<'_>, now_us: u64) {
        let TickState {
            sensors,
            estimate,
            operator,
            safety,
            balance,
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
        let (motor, geometry) = (&sensors.motor, &self.legs);
        // Legs that only hold their pose are not worth the time.
        let legs = || {
            let stands = act::stands(safety, balance);
            stands.then(|| known_legs(geometry, motor)).flatten()
        };
        self.estimator
            .step_on_legs(imu, mag, motor, legs, now_us, estimate);
    }

    /// Returns the command of bring-up, which replaces any other.
    fn step_bring_up(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> Option<ChassisCommand> {
        let state = &mut self.state;
        let link = &inputs.remote.diagnostics;
        let known = &state.link;
        let news = known.frames != link.frames || known.frame_ts_us != link.frame_ts_us;
        if news || self.phase == 0 {
            state.link = link.at(now_us);
        } else {
            // The rate falls slowly, and the age stops the robot.
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
