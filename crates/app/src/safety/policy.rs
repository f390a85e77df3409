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
        flags.set(SafetyFlags::TASK_LATE, inputs.health.late_tasks.any());
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

#[cfg(test)]
mod tests {
    use super::*;

    const NOW_US: u64 = 10_000_000;

    /// Nothing wrong, then one change.
    fn judge(change: impl FnOnce(&mut SystemHealth, &mut RemoteDiagnostics)) -> SafetyStatus {
        let mut health = SystemHealth::default();
        let mut remote = RemoteDiagnostics {
            quality: 1.0,
            frames: 100,
            age_us: 7_000,
            ..RemoteDiagnostics::default()
        };
        change(&mut health, &mut remote);
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            wheel.age_us = 1_000;
        }
        let inputs = SafetyInputs {
            remote: &remote,
            operator: &OperatorState {
                e_stop: false,
                ..OperatorState::default()
            },
            imu_ts_us: NOW_US - 5_000,
            estimate: &StateEstimate {
                valid: true,
                ..StateEstimate::default()
            },
            motor: &motor,
            motor_timeout_us: 50_000,
            command_ts_us: NOW_US - 10_000,
            health: &health,
        };
        SafetyPolicy::new(SafetyConfig::default()).evaluate(&inputs, NOW_US)
    }

    #[test]
    fn with_nothing_wrong_it_runs() {
        let status = judge(|_, _| ());
        assert_eq!(status.flags, SafetyFlags::NONE);
        assert_eq!(status.verdict, SafetyVerdict::Run);
        assert!(BusId::ALL.iter().all(|bus| !status.stops(*bus)));
    }

    #[test]
    fn a_bad_bus_stops_only_its_own_actuators() {
        let off = judge(|health, _| health.can[0].state = BusErrorState::BusOff);
        let congested = judge(|health, _| health.can[0].tx_failures_in_row = 21);
        assert_eq!(off.flags, SafetyFlags::CAN1_FAULT);
        assert_eq!(congested.flags, SafetyFlags::CAN1_CONGESTED);
        for status in [off, congested] {
            assert_eq!(status.verdict, SafetyVerdict::BusStop);
            assert!(status.stops(BusId::Can1) && !status.stops(BusId::Can2));
        }
        let other = judge(|health, _| health.can[1].state = BusErrorState::BusOff);
        assert_eq!(other.verdict, SafetyVerdict::Run);
        assert!(other.stops(BusId::Can2) && !other.stops(BusId::Can1));
    }

    /// The limit is 20, and the first tick forgives one.
    #[test]
    fn accumulated_sensor_errors_stop_everything() {
        let imu = judge(|health, _| health.imu.errors = 22);
        let mag = judge(|health, _| health.mag.errors = 22);
        assert_eq!(imu.flags, SafetyFlags::IMU_ERRORS);
        assert_eq!(mag.flags, SafetyFlags::MAG_ERRORS);
        for status in [imu, mag] {
            assert!(BusId::ALL.iter().all(|bus| status.stops(*bus)));
        }
    }

    #[test]
    fn a_late_task_stops_everything() {
        let late = judge(|health, _| health.late_tasks.status = true);
        assert_eq!(late.flags, SafetyFlags::TASK_LATE);
        assert_eq!(late.verdict, SafetyVerdict::GlobalStop);
    }

    #[test]
    fn a_bad_link_stops_everything() {
        let lossy = judge(|_, remote| remote.quality = 0.49);
        let silent = judge(|_, remote| remote.age_us = 100_001);
        let failsafe = judge(|_, remote| remote.failsafe = true);
        assert_eq!(lossy.flags, SafetyFlags::REMOTE_QUALITY);
        assert_eq!(silent.flags, SafetyFlags::REMOTE_LOST);
        assert_eq!(failsafe.flags, SafetyFlags::REMOTE_FAILSAFE);
        for status in [lossy, silent, failsafe] {
            assert_eq!(status.verdict, SafetyVerdict::GlobalStop);
        }
    }
}
