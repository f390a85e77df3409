//! The only place that decides whether outputs must stop (docs/safety.md#the-rules).

use super::{
    SafetyFlags, SafetyStatus,
    arming::SETTINGS_LAG_US,
    battery_limits::BatteryLimits,
    debounce::Debounce,
    fall_detector::FallDetector,
    latch::Latches,
    leaky_bucket::LeakyBucket,
    pc_interlock::{PcInputs, PcInterlock},
    resume_interlock::{ResumeInterlock, WATCHED},
    standing::{Standing, StandingInputs},
    temperature_limits::TemperatureLimits,
};
use crate::domain::{
    BalanceState, BusErrorState, BusHealth, JointState, MotorFeedback, OperatorState,
    RemoteDiagnostics, SafetyConfig, StandSwitch, StandUpConfig, StateEstimate, SystemHealth,
    age_us,
};

/// Longest time step that counts towards a duration, so that a jump of the clock does not.
const MAX_DT_US: u32 = 20_000;
/// Time within which a joint must become ready. Set-up and enabling take a tenth of it. A DM4310 that writes a
/// register is silent meanwhile, which restarts the time.
const JOINT_READY_US: u32 = 1_000_000;

/// Inputs of the policy.
#[derive(Clone, Copy, Debug)]
pub struct SafetyInputs<'a> {
    /// Limits.
    pub config: &'a SafetyConfig,
    /// Limits of standing up.
    pub stand_up: &'a StandUpConfig,
    /// The link as of now: see `RemoteDiagnostics::at`.
    pub remote: &'a RemoteDiagnostics,
    /// The pilot's switches.
    pub operator: &'a OperatorState,
    /// The robot was armed in the last tick.
    pub armed: bool,
    /// State of the balance controller in the last tick.
    pub balance: BalanceState,
    /// The robot is disarmed, or the sticks are centred, so that no part starts at full stick.
    pub may_resume: bool,
    /// Time of the last IMU sample, 0 = none yet.
    pub imu_ts_us: u64,
    /// Attitude and motion.
    pub estimate: &'a StateEstimate,
    /// Feedback of all motors.
    pub motor: &'a MotorFeedback,
    /// Maximum age of wheel feedback.
    pub motor_timeout_us: u32,
    /// Time of the last decision on the logic bus, 0 = none yet.
    pub command_ts_us: u64,
    /// The PC.
    pub pc: PcInputs<'a>,
    /// State of buses, sensors, battery and tasks.
    pub health: &'a SystemHealth,
}

/// Evaluates all stop conditions, with debouncing and latches.
///
/// ```
/// use robot_app::domain::*;
/// use robot_app::safety::{PcInputs, SafetyFlags, SafetyInputs, SafetyPolicy, SafetyVerdict};
///
/// let config = SafetyConfig::default();
/// let inputs = SafetyInputs {
///     config: &config,
///     stand_up: &StandUpConfig::default(),
///     armed: false,
///     balance: BalanceState::Sit,
///     remote: &RemoteDiagnostics { age_us: config.remote_timeout_us + 1, ..Default::default() },
///     operator: &OperatorState::default(),
///     may_resume: true,
///     imu_ts_us: 1_000_000,
///     estimate: &StateEstimate::default(),
///     motor: &MotorFeedback::default(),
///     motor_timeout_us: 50_000,
///     command_ts_us: 0,
///     pc: PcInputs { command: &PcCommand::default(), mode: false, steering: false, stands: false },
///     health: &SystemHealth::default(),
/// };
/// let status = SafetyPolicy::default().evaluate(&inputs, 1_000_000);
/// assert!(status.flags.intersects(SafetyFlags::REMOTE_LOST));
/// assert_eq!(status.verdict, SafetyVerdict::GlobalStop);
/// assert!(status.stops_wheels(BusId::Can1));
/// ```
#[derive(Clone, Debug, Default)]
pub struct SafetyPolicy {
    imu_errors: LeakyBucket,
    mag_errors: LeakyBucket,
    tilt: FallDetector,
    toppling: FallDetector,
    standing: Standing,
    /// Frames older than this do not move the stand switch.
    trusted_from_us: u64,
    heat: TemperatureLimits,
    battery: BatteryLimits,
    joint_unready: Debounce,
    latches: Latches,
    resume: ResumeInterlock,
    pc: PcInterlock,
    flags_seen: SafetyFlags,
    ts_us: u64,
}

impl SafetyPolicy {
    /// Evaluates all conditions; called once a tick.
    pub fn evaluate(&mut self, inputs: &SafetyInputs<'_>, now_us: u64) -> SafetyStatus {
        let dt_us = self.dt_us(now_us);
        let mut flags = SafetyFlags::NONE;
        check_remote(inputs, &mut flags);
        self.check_sensors(inputs, now_us, &mut flags);
        check_buses(inputs, &mut flags);
        check_wheels(inputs, &mut flags);
        self.check_joints(inputs, dt_us, &mut flags);
        self.heat
            .check(inputs.motor, inputs.config, dt_us, &mut flags);
        let battery_v = inputs.health.battery_v;
        self.battery
            .check(battery_v, inputs.config, dt_us, &mut flags);
        let command_age_us = age_us(inputs.command_ts_us, now_us);
        flags.add_if(
            SafetyFlags::COMMAND_STALE,
            command_age_us > inputs.config.command_timeout_us,
        );
        flags.add_if(SafetyFlags::TASK_LATE, inputs.health.late_tasks.any());
        flags.insert(self.check_standing(flags, inputs, dt_us, now_us));
        self.summarise(flags, inputs, dt_us, now_us)
    }

    /// Forgets the request to stand after a change of settings. Another channel may have become the stand switch, so it
    /// must be seen down in frames that came after the change.
    pub fn settings_changed(&mut self, now_us: u64) {
        self.standing.restart();
        self.trusted_from_us = now_us.saturating_add(SETTINGS_LAG_US);
    }

    /// Time since the last tick, 0 in the first one.
    fn dt_us(&mut self, now_us: u64) -> u32 {
        let last_us = core::mem::replace(&mut self.ts_us, now_us);
        if last_us == 0 {
            return 0;
        }
        age_us(last_us, now_us).min(MAX_DT_US)
    }

    fn check_sensors(&mut self, inputs: &SafetyInputs<'_>, now_us: u64, flags: &mut SafetyFlags) {
        let (health, config) = (inputs.health, inputs.config);
        flags.add_if(SafetyFlags::ESTIMATE_INVALID, !inputs.estimate.valid);
        flags.add_if(
            SafetyFlags::IMU_STALE,
            age_us(inputs.imu_ts_us, now_us) > config.imu_timeout_us,
        );
        flags.add_if(
            SafetyFlags::IMU_ERRORS,
            self.imu_errors.exceeded(health.imu.errors, config, now_us),
        );
        flags.add_if(
            SafetyFlags::MAG_ERRORS,
            self.mag_errors.exceeded(health.mag.errors, config, now_us),
        );
    }

    fn check_joints(&mut self, inputs: &SafetyInputs<'_>, dt_us: u32, flags: &mut SafetyFlags) {
        let mut unready = false;
        for joint in &inputs.motor.joints {
            let silent =
                joint.state == JointState::Silent || joint.age_us > inputs.config.joint_timeout_us;
            flags.add_if(SafetyFlags::JOINT_SILENT, silent);
            flags.add_if(SafetyFlags::JOINT_FAULT, joint.state == JointState::Fault);
            flags.add_if(SafetyFlags::JOINT_FROZEN, joint.frozen);
            unready |= matches!(joint.state, JointState::SettingUp | JointState::Enabling);
        }
        let unready = self.joint_unready.held(unready, dt_us, JOINT_READY_US);
        flags.add_if(SafetyFlags::JOINT_NOT_READY, unready);
    }

    /// Returns the flags of falls. `present` are all others.
    fn check_standing(
        &mut self,
        present: SafetyFlags,
        inputs: &SafetyInputs<'_>,
        dt_us: u32,
        now_us: u64,
    ) -> SafetyFlags {
        let fallen = self.tilt.fallen(inputs.estimate, inputs.config, dt_us);
        let others = present
            .union(self.latches.latched())
            .difference(SafetyFlags::FALLEN);
        let switch = if inputs.operator.ts_us >= self.trusted_from_us {
            inputs.operator.stand
        } else {
            StandSwitch::Unknown
        };
        let sits = inputs.balance == BalanceState::Sit;
        if sits && switch != StandSwitch::Up && self.standing.is_idle() {
            let stopped = others.intersects(SafetyFlags::GLOBAL_STOP);
            self.standing.idle(switch, stopped);
            let mut flags = SafetyFlags::NONE;
            flags.add_if(SafetyFlags::TILT, fallen);
            return flags;
        }
        self.stand(others, switch, fallen, inputs, dt_us, now_us)
    }

    /// Kept out of line, so that it costs nothing while the robot sits.
    #[inline(never)]
    fn stand(
        &mut self,
        others: SafetyFlags,
        switch: StandSwitch,
        fallen: bool,
        inputs: &SafetyInputs<'_>,
        dt_us: u32,
        now_us: u64,
    ) -> SafetyFlags {
        let flags = self.standing.step(
            &StandingInputs {
                switch,
                armed: inputs.armed,
                balance: inputs.balance,
                fallen,
                topples: inputs.balance != BalanceState::Sit
                    && self.toppling.topples(inputs.estimate, inputs.config, dt_us),
                stopped: others.intersects(SafetyFlags::GLOBAL_STOP),
                part_stopped: others.intersects(WATCHED),
                time_us: inputs.stand_up.time_us,
            },
            now_us,
        );
        if self.standing.permit().may_lie() {
            self.latches.release(SafetyFlags::FALLEN);
        }
        flags
    }

    /// Adds the latched conditions to those that are `present`, and derives what stops.
    fn summarise(
        &mut self,
        present: SafetyFlags,
        inputs: &SafetyInputs<'_>,
        dt_us: u32,
        now_us: u64,
    ) -> SafetyStatus {
        let link_bad = SafetyFlags::REMOTE_LOST
            .union(SafetyFlags::REMOTE_FAILSAFE)
            .union(SafetyFlags::REMOTE_QUALITY);
        let gesture =
            !present.intersects(link_bad) && inputs.operator.disabled && inputs.operator.e_stop;
        let hold_us = inputs.config.clear_hold_us;
        let (latched, clear_faults) = self.latches.step(present, gesture, dt_us, hold_us);
        let mut flags = present.union(latched);
        let may_resume = inputs.may_resume || inputs.config.resume_centred == 0;
        let over = self.resume.step(flags, may_resume);
        let stopping = flags.union(over);
        flags.add_if(SafetyFlags::STICKS_AWAITED, !over.is_empty());
        let pc = &inputs.pc;
        flags.insert(
            self.pc
                .step(pc, stopping, inputs.config, inputs.motor, now_us),
        );
        self.flags_seen = self.flags_seen.union(flags);
        SafetyStatus {
            flags,
            latched,
            clear_faults,
            flags_seen: self.flags_seen,
            pc_stop: !self.pc.is_released(),
            stand: self.standing.permit(),
            stand_up_ms: self.standing.stand_up_ms(),
            ..SafetyStatus::from_flags(stopping)
        }
    }
}

fn check_remote(inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
    let (remote, config) = (inputs.remote, inputs.config);
    flags.add_if(
        SafetyFlags::REMOTE_LOST,
        remote.age_us > config.remote_timeout_us,
    );
    flags.add_if(SafetyFlags::REMOTE_FAILSAFE, remote.failsafe);
    let good_enough = remote.quality >= config.min_remote_quality;
    flags.add_if(
        SafetyFlags::REMOTE_QUALITY,
        remote.frames > 0 && !good_enough,
    );
    flags.add_if(SafetyFlags::E_STOP, inputs.operator.e_stop);
}

fn check_buses(inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
    let [can1, can2] = &inputs.health.can;
    let faulty = |bus: &BusHealth| bus.state == BusErrorState::BusOff;
    let congested = |bus: &BusHealth| bus.tx_failures_in_row > inputs.config.max_tx_failures;
    flags.add_if(SafetyFlags::CAN1_FAULT, faulty(can1));
    flags.add_if(SafetyFlags::CAN2_FAULT, faulty(can2));
    flags.add_if(SafetyFlags::CAN1_CONGESTED, congested(can1));
    flags.add_if(SafetyFlags::CAN2_CONGESTED, congested(can2));
}

fn check_wheels(inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
    let [left, right] = &inputs.motor.wheels;
    let timeout_us = inputs.motor_timeout_us;
    flags.add_if(SafetyFlags::WHEEL_LEFT_SILENT, left.age_us > timeout_us);
    flags.add_if(SafetyFlags::WHEEL_RIGHT_SILENT, right.age_us > timeout_us);
    flags.add_if(SafetyFlags::WHEEL_FROZEN, left.frozen || right.frozen);
}

#[cfg(test)]
mod tests;
