use super::*;
use crate::{
    domain::{BusId, PcCommand},
    safety::SafetyVerdict,
};

mod battery;
mod clearing;
mod motors;
mod pc;
mod resuming;
mod standing;

/// A policy and its inputs. Initially nothing is wrong, and one tick has run.
struct Bench {
    policy: SafetyPolicy,
    config: SafetyConfig,
    remote: RemoteDiagnostics,
    operator: OperatorState,
    estimate: StateEstimate,
    motor: MotorFeedback,
    health: SystemHealth,
    imu_age_us: u64,
    command_age_us: u64,
    may_resume: bool,
    pc: PcCommand,
    pc_mode: bool,
    pc_steering: bool,
    pc_stands: bool,
    armed: bool,
    balance: BalanceState,
    stand_up: StandUpConfig,
    now_us: u64,
}

impl Bench {
    fn new() -> Self {
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            wheel.age_us = 1_000;
        }
        for joint in &mut motor.joints {
            joint.age_us = 2_000;
            joint.state = JointState::Disabled;
            joint.temperature_c = 30.0;
        }
        let mut bench = Self {
            policy: SafetyPolicy::default(),
            config: SafetyConfig::default(),
            remote: RemoteDiagnostics {
                quality: 1.0,
                frames: 100,
                age_us: 7_000,
                ..RemoteDiagnostics::default()
            },
            operator: OperatorState {
                e_stop: false,
                ..OperatorState::default()
            },
            estimate: StateEstimate {
                valid: true,
                ..StateEstimate::default()
            },
            motor,
            health: SystemHealth {
                battery_v: 24.0,
                ..SystemHealth::default()
            },
            imu_age_us: 5_000,
            command_age_us: 10_000,
            may_resume: true,
            pc: PcCommand::default(),
            pc_mode: false,
            pc_steering: false,
            pc_stands: false,
            armed: false,
            balance: BalanceState::Sit,
            stand_up: StandUpConfig::default(),
            now_us: 10_000_000,
        };
        bench.tick();
        bench
    }

    /// Runs one tick without advancing the time.
    fn tick(&mut self) -> SafetyStatus {
        self.policy.evaluate(
            &SafetyInputs {
                config: &self.config,
                stand_up: &self.stand_up,
                armed: self.armed,
                balance: self.balance,
                remote: &self.remote,
                operator: &self.operator,
                may_resume: self.may_resume,
                imu_ts_us: self.now_us - self.imu_age_us,
                estimate: &self.estimate,
                motor: &self.motor,
                motor_timeout_us: 50_000,
                command_ts_us: self.now_us - self.command_age_us,
                pc: PcInputs {
                    command: &self.pc,
                    mode: self.pc_mode,
                    steering: self.pc_steering,
                    stands: self.pc_stands,
                },
                health: &self.health,
            },
            self.now_us,
        )
    }

    /// Runs ticks of 1 ms and returns the last status.
    fn run(&mut self, milliseconds: u32) -> SafetyStatus {
        let mut status = self.tick();
        for _ in 0..milliseconds {
            self.now_us += 1_000;
            status = self.tick();
        }
        status
    }

    /// Milliseconds until the flag is set, or `None` if that takes more than three seconds.
    fn ms_until(&mut self, flag: SafetyFlags) -> Option<u32> {
        (1..=3_000).find(|_| {
            self.now_us += 1_000;
            self.tick().flags.intersects(flag)
        })
    }

    /// Enable off and e-stop thrown.
    fn gesture(&mut self, on: bool) {
        self.operator.disabled = on;
        self.operator.e_stop = on;
    }
}

/// The first tick after one change to a healthy robot.
fn with_change(change: impl FnOnce(&mut Bench)) -> SafetyStatus {
    let mut bench = Bench::new();
    change(&mut bench);
    bench.tick()
}

fn stops(status: &SafetyStatus) -> [bool; 4] {
    let [can1, can2] = [BusId::Can1, BusId::Can2];
    [
        status.stops_wheels(can1),
        status.stops_wheels(can2),
        status.stops_joints(can1),
        status.stops_joints(can2),
    ]
}

#[test]
fn without_faults_nothing_is_stopped() {
    let status = Bench::new().run(3_000);
    assert_eq!(status.flags, SafetyFlags::NONE);
    assert_eq!(status.verdict, SafetyVerdict::Run);
    assert_eq!(stops(&status), [false; 4]);
}

#[test]
fn a_faulty_bus_stops_only_its_own_actuators() {
    let cases = [
        (0, SafetyFlags::CAN1_FAULT, SafetyFlags::CAN1_CONGESTED),
        (1, SafetyFlags::CAN2_FAULT, SafetyFlags::CAN2_CONGESTED),
    ];
    for (bus, fault, congestion) in cases {
        let off = with_change(|bench| bench.health.can[bus].state = BusErrorState::BusOff);
        let congested = with_change(|bench| bench.health.can[bus].tx_failures_in_row = 21);
        assert_eq!((off.flags, congested.flags), (fault, congestion));
        for status in [off, congested] {
            assert_eq!(status.verdict, SafetyVerdict::PartialStop);
            assert_eq!(stops(&status), [bus == 0, bus == 1, bus == 0, bus == 1]);
        }
    }
}

/// The limit is 20.
#[test]
fn accumulated_sensor_errors_stop_everything_until_cleared() {
    type Fault = fn(&mut Bench);
    let imu: Fault = |bench| bench.health.imu.errors = 21;
    let mag: Fault = |bench| bench.health.mag.errors = 21;
    let cases = [
        (imu, SafetyFlags::IMU_ERRORS),
        (mag, SafetyFlags::MAG_ERRORS),
    ];
    for (inject, flag) in cases {
        let mut bench = Bench::new();
        inject(&mut bench);
        assert_eq!(bench.tick().flags, flag);
        let later = bench.run(10_000);
        assert_eq!((later.flags, later.latched), (flag, flag));
        assert_eq!(stops(&later), [true; 4]);
        bench.gesture(true);
        bench.run(1_001);
        bench.gesture(false);
        assert_eq!(bench.tick().flags, SafetyFlags::NONE);
    }
}

/// With default settings a value at its limit is allowed, and the next one is not.
#[test]
fn values_at_their_limits_are_allowed() {
    type Set = fn(&mut Bench, u32);
    let cases: [(Set, SafetyFlags); 7] = [
        (
            |bench, more| bench.remote.age_us = 100_000 + more,
            SafetyFlags::REMOTE_LOST,
        ),
        (
            |bench, more| bench.imu_age_us = u64::from(25_000 + more),
            SafetyFlags::IMU_STALE,
        ),
        (
            |bench, more| bench.command_age_us = u64::from(50_000 + more),
            SafetyFlags::COMMAND_STALE,
        ),
        (
            |bench, more| bench.motor.wheels[0].age_us = 50_000 + more,
            SafetyFlags::WHEEL_LEFT_SILENT,
        ),
        (
            |bench, more| bench.motor.wheels[1].age_us = 50_000 + more,
            SafetyFlags::WHEEL_RIGHT_SILENT,
        ),
        (
            |bench, more| bench.motor.joints[3].age_us = 50_000 + more,
            SafetyFlags::JOINT_SILENT,
        ),
        (
            |bench, more| bench.health.can[0].tx_failures_in_row = 20 + more,
            SafetyFlags::CAN1_CONGESTED,
        ),
    ];
    for (set, flag) in cases {
        assert_eq!(with_change(|bench| set(bench, 0)).flags, SafetyFlags::NONE);
        assert_eq!(with_change(|bench| set(bench, 1)).flags, flag);
    }
}

#[test]
fn quality_is_not_judged_before_the_first_frame() {
    let silent = with_change(|bench| (bench.remote.frames, bench.remote.quality) = (0, 0.0));
    assert_eq!(silent.flags, SafetyFlags::NONE);
}

#[test]
fn a_late_task_stops_everything() {
    let late = with_change(|bench| bench.health.late_tasks.status = true);
    assert_eq!(late.flags, SafetyFlags::TASK_LATE);
    assert_eq!(late.verdict, SafetyVerdict::GlobalStop);
}

#[test]
fn a_bad_link_stops_everything() {
    let lossy = with_change(|bench| bench.remote.quality = 0.49);
    let unknown = with_change(|bench| bench.remote.quality = f32::NAN);
    let silent = with_change(|bench| bench.remote.age_us = 100_001);
    let failsafe = with_change(|bench| bench.remote.failsafe = true);
    assert_eq!(lossy.flags, SafetyFlags::REMOTE_QUALITY);
    assert_eq!(unknown.flags, SafetyFlags::REMOTE_QUALITY);
    assert_eq!(silent.flags, SafetyFlags::REMOTE_LOST);
    assert_eq!(failsafe.flags, SafetyFlags::REMOTE_FAILSAFE);
    for status in [lossy, unknown, silent, failsafe] {
        assert_eq!(status.verdict, SafetyVerdict::GlobalStop);
        assert_eq!(stops(&status), [true; 4]);
    }
}
