//! The only place that decides whether outputs must stop (seed section 0.6, design.md section 3).

use super::{SafetyFlags, error_account::ErrorAccount};
use crate::{
    domain::{
        BusErrorState, BusHealth, BusId, MotorFeedback, OperatorState, RemoteDiagnostics,
        SafetyConfig, StateEstimate, SystemHealth, age_us,
    },
    motor::WHEEL_BUS,
};

/// How far outputs are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum SafetyVerdict {
    Run = 0,
    /// Only the actuators of the stopped buses.
    BusStop = 1,
    #[default]
    GlobalStop = 2,
}

/// What the policy found in one tick. Until it looked: everything stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct SafetyStatus {
    pub flags: SafetyFlags,
    pub verdict: SafetyVerdict,
    /// Index = `BusId`.
    pub bus_stop: [bool; 2],
    /// Every flag raised since boot.
    pub flags_seen: SafetyFlags,
}

impl Default for SafetyStatus {
    fn default() -> Self {
        Self {
            flags: SafetyFlags::NONE,
            verdict: SafetyVerdict::GlobalStop,
            bus_stop: [true; 2],
            flags_seen: SafetyFlags::NONE,
        }
    }
}

impl SafetyStatus {
    pub fn stops(&self, bus: BusId) -> bool {
        let [can1, can2] = self.bus_stop;
        let bus_stop = match bus {
            BusId::Can1 => can1,
            BusId::Can2 => can2,
        };
        bus_stop || self.verdict == SafetyVerdict::GlobalStop
    }
}

/// All the policy looks at.
#[derive(Clone, Copy, Debug)]
pub struct SafetyInputs<'a> {
    /// As of now: see `RemoteDiagnostics::at`.
    pub remote: &'a RemoteDiagnostics,
    pub operator: &'a OperatorState,
    /// Last IMU sample, 0 = none yet.
    pub imu_ts_us: u64,
    pub estimate: &'a StateEstimate,
    pub motor: &'a MotorFeedback,
    pub motor_timeout_us: u32,
    /// Last decision on the logic bus, 0 = none yet.
    pub command_ts_us: u64,
    pub health: &'a SystemHealth,
}

/// Keeps the sensors' error accounts; everything else is decided from this tick alone.
#[derive(Clone, Debug)]
pub struct SafetyPolicy {
    config: SafetyConfig,
    imu_errors: ErrorAccount,
    mag_errors: ErrorAccount,
    flags_seen: SafetyFlags,
}

impl SafetyPolicy {
    pub fn new(config: SafetyConfig) -> Self {
        Self {
            config,
            imu_errors: ErrorAccount::default(),
            mag_errors: ErrorAccount::default(),
            flags_seen: SafetyFlags::NONE,
        }
    }

    pub fn evaluate(&mut self, inputs: &SafetyInputs<'_>, now_us: u64) -> SafetyStatus {
        let mut flags = SafetyFlags::NONE;
        self.judge_remote(inputs, &mut flags);
        self.judge_sensors(inputs, now_us, &mut flags);
        self.judge_buses(inputs.health, &mut flags);
        let [left, right] = &inputs.motor.wheels;
        flags.set(
            SafetyFlags::WHEEL_LEFT_SILENT,
            left.age_us > inputs.motor_timeout_us,
        );
        flags.set(
            SafetyFlags::WHEEL_RIGHT_SILENT,
            right.age_us > inputs.motor_timeout_us,
        );
        flags.set(
            SafetyFlags::COMMAND_STALE,
            age_us(inputs.command_ts_us, now_us) > self.config.command_timeout_us,
        );
        self.flags_seen = self.flags_seen.and(flags);
        self.conclude(flags)
    }

    fn judge_remote(&self, inputs: &SafetyInputs<'_>, flags: &mut SafetyFlags) {
        let remote = inputs.remote;
        flags.set(
            SafetyFlags::REMOTE_LOST,
            remote.age_us > self.config.remote_timeout_us,
        );
        flags.set(SafetyFlags::REMOTE_FAILSAFE, remote.failsafe);
        flags.set(
            SafetyFlags::REMOTE_QUALITY,
            remote.frames > 0 && remote.quality < self.config.min_remote_quality,
        );
        flags.set(SafetyFlags::E_STOP, inputs.operator.e_stop);
    }

    fn judge_sensors(&mut self, inputs: &SafetyInputs<'_>, now_us: u64, flags: &mut SafetyFlags) {
        let health = inputs.health;
        flags.set(SafetyFlags::ESTIMATE_INVALID, !inputs.estimate.valid);
        flags.set(
            SafetyFlags::IMU_STALE,
            age_us(inputs.imu_ts_us, now_us) > self.config.imu_timeout_us,
        );
        flags.set(
            SafetyFlags::IMU_ERRORS,
            self.imu_errors
                .exceeded(health.imu.errors, &self.config, now_us),
        );
        flags.set(
            SafetyFlags::MAG_ERRORS,
            self.mag_errors
                .exceeded(health.mag.errors, &self.config, now_us),
        );
    }

    fn judge_buses(&self, health: &SystemHealth, flags: &mut SafetyFlags) {
        let [can1, can2] = &health.can;
        let faulty = |bus: &BusHealth| bus.state == BusErrorState::BusOff;
        let congested = |bus: &BusHealth| bus.tx_failures_in_row > self.config.max_tx_failures;
        flags.set(SafetyFlags::CAN1_FAULT, faulty(can1));
        flags.set(SafetyFlags::CAN2_FAULT, faulty(can2));
        flags.set(SafetyFlags::CAN1_CONGESTED, congested(can1));
        flags.set(SafetyFlags::CAN2_CONGESTED, congested(can2));
    }

    fn conclude(&self, flags: SafetyFlags) -> SafetyStatus {
        let can1 = SafetyFlags::CAN1_FAULT.and(SafetyFlags::CAN1_CONGESTED);
        let can2 = SafetyFlags::CAN2_FAULT.and(SafetyFlags::CAN2_CONGESTED);
        let bus_stop = [flags.intersects(can1), flags.intersects(can2)];
        let [can1_stop, can2_stop] = bus_stop;
        let actuators_stopped = match WHEEL_BUS {
            BusId::Can1 => can1_stop,
            BusId::Can2 => can2_stop,
        };
        let verdict = if flags.intersects(SafetyFlags::GLOBAL_STOP) {
            SafetyVerdict::GlobalStop
        } else if actuators_stopped {
            SafetyVerdict::BusStop
        } else {
            SafetyVerdict::Run
        };
        SafetyStatus {
            flags,
            verdict,
            bus_stop,
            flags_seen: self.flags_seen,
        }
    }
}
