//! The only place that decides whether outputs must stop (docs/safety.md#the-rules).

use super::{
    SafetyFlags, SafetyStatus, battery::BatteryWatch, debounce::Debounce,
    error_account::ErrorAccount, heat::HeatWatch, latch::Latches, resume::ResumeWatch,
    tilt::TiltWatch,
};
use crate::domain::{
    BusErrorState, BusHealth, JointState, MotorFeedback, OperatorState, RemoteDiagnostics,
    SafetyConfig, StateEstimate, SystemHealth, age_us,
};

/// Longest step of time that counts for anything that must last: a jump of the clock is no duration.
const MAX_DT_US: u32 = 20_000;
/// Set-up and enabling take a tenth of it; a DM4310 that writes a register is silent meanwhile, which starts it anew.
const JOINT_READY_US: u32 = 1_000_000;

/// All the policy looks at.
#[derive(Clone, Copy, Debug)]
pub struct SafetyInputs<'a> {
    pub config: &'a SafetyConfig,
    /// As of now: see `RemoteDiagnostics::at`.
    pub remote: &'a RemoteDiagnostics,
    pub operator: &'a OperatorState,
    /// The robot is disarmed, or the pilot's sticks rest in the centre: nothing sets off at full stick.
    pub may_resume: bool,
    /// Last IMU sample, 0 = none yet.
    pub imu_ts_us: u64,
    pub estimate: &'a StateEstimate,
    pub motor: &'a MotorFeedback,
    /// Of the wheels.
    pub motor_timeout_us: u32,
    /// Last decision on the logic bus, 0 = none yet.
    pub command_ts_us: u64,
    pub health: &'a SystemHealth,
}

/// Keeps what must last before it counts, and what stays until it is cleared.
#[derive(Clone, Debug, Default)]
pub struct SafetyPolicy {
    imu_errors: ErrorAccount,
    mag_errors: ErrorAccount,
    tilt: TiltWatch,
    heat: HeatWatch,
    battery: BatteryWatch,
    joint_unready: Debounce,
    latches: Latches,
    resume: ResumeWatch,
    flags_seen: SafetyFlags,
    ts_us: u64,
}

impl SafetyPolicy {
    /// Once a tick.
    pub fn evaluate(&mut self, inputs: &SafetyInputs<'_>, now_us: u64) -> SafetyStatus {
        let dt_us = self.dt_us(now_us);
        let mut flags = SafetyFlags::NONE;
        judge_remote(inputs, &mut flags);
        self.judge_sensors(inputs, now_us, &mut flags);
        judge_buses(inputs, &mut flags);
        judge_wheels(inputs, &mut flags);
        self.judge_joints(inputs, dt_us, &mut flags);
        self.heat
            .judge(inputs.motor, inputs.config, dt_us, &mut flags);
        let battery_v = inputs.health.battery_v;
        self.battery
            .judge(battery_v, inputs.config, dt_us, &mut flags);
        let fallen = self.tilt.fallen(inputs.estimate, inputs.config, dt_us);
        flags.add_if(SafetyFlags::TILT, fallen);
        let command_age_us = age_us(inputs.command_ts_us, now_us);
        flags.add_if(
            SafetyFlags::COMMAND_STALE,
            command_age_us > inputs.config.command_timeout_us,
        );
        flags.add_if(SafetyFlags::TASK_LATE, inputs.health.late_tasks.any());
        self.conclude(flags, inputs, dt_us)
    }

    /// Since the last tick; 0 in the first.
    fn dt_us(&mut self, now_us: u64) -> u32 {
        let last_us = core::mem::replace(&mut self.ts_us, now_us);
        if last_us == 0 {
            return 0;
        }
        age_us(last_us, now_us).min(MAX_DT_US)
    }

    fn judge_sensors(&mut self, inputs: &SafetyInputs<'_>, now_us: u64, flags: &mut SafetyFlags) {
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

    fn judge_joints(&mut self, inputs: &SafetyInputs<'_>, dt_us: u32, flags: &mut SafetyFlags) {
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

    /// Adds what is latched to what is `present`.
    fn conclude(
        &mut self,
        present: SafetyFlags,
        inputs: &SafetyInputs<'_>,
        dt_us: u32,
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
        self.flags_seen = self.flags_seen.union(flags);
        SafetyStatus {
            flags,
            latched,
            clear_faults,
            flags_seen: self.flags_seen,
            ..SafetyStatus::of(stopping)
        }
    }
}

fn judge_remote(inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
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

fn judge_buses(inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
    let [can1, can2] = &inputs.health.can;
    let faulty = |bus: &BusHealth| bus.state == BusErrorState::BusOff;
    let congested = |bus: &BusHealth| bus.tx_failures_in_row > inputs.config.max_tx_failures;
    flags.add_if(SafetyFlags::CAN1_FAULT, faulty(can1));
    flags.add_if(SafetyFlags::CAN2_FAULT, faulty(can2));
    flags.add_if(SafetyFlags::CAN1_CONGESTED, congested(can1));
    flags.add_if(SafetyFlags::CAN2_CONGESTED, congested(can2));
}

fn judge_wheels(inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
    let [left, right] = &inputs.motor.wheels;
    let timeout_us = inputs.motor_timeout_us;
    flags.add_if(SafetyFlags::WHEEL_LEFT_SILENT, left.age_us > timeout_us);
    flags.add_if(SafetyFlags::WHEEL_RIGHT_SILENT, right.age_us > timeout_us);
    flags.add_if(SafetyFlags::WHEEL_FROZEN, left.frozen || right.frozen);
}

#[cfg(test)]
mod tests;
