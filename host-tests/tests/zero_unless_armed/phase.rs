//! What goes into the tick, stretch by stretch.

use proptest::prelude::*;
use robot_app::{
    domain::{
        BusErrorState, ChassisCommand, DriveMode, HighLevelCommand, ImuState, MagState, OperatorState,
        RemoteDiagnostics, RemoteState, RemoteUpdate, SystemHealth, WheelCommand,
    },
    logic::LogicBus,
    tick::ControlInputs,
};

/// One stretch of ticks in which the same things are right or wrong.
#[derive(Clone, Debug)]
pub struct Phase {
    pub ticks: u16,
    pub enabled: bool,
    pub e_stop: bool,
    pub failsafe: bool,
    pub radio_sends: bool,
    pub quality: f32,
    pub sticks: (f32, f32),
    pub imu_sends: bool,
    pub accel: [f32; 3],
    pub gyro: [f32; 3],
    pub gyro_bias: [f32; 3],
    pub mag: [f32; 3],
    pub calibrated: bool,
    pub can1: BusErrorState,
    pub logic_sends: bool,
    /// Currents past the controller, both wheels, mA.
    pub direct_ma: Option<f32>,
    pub imu_errors: u32,
    pub time_jump_us: u64,
    pub frame: (u16, Vec<u8>),
}

/// Mostly as it should be, with anything possible.
fn mostly<T: Clone + std::fmt::Debug + 'static>(
    usual: T,
    odd: impl Strategy<Value = T> + 'static,
) -> impl Strategy<Value = T> {
    prop_oneof![9 => Just(usual), 1 => odd]
}

pub fn phases() -> impl Strategy<Value = Vec<Phase>> {
    let switches = (
        any::<bool>(),
        mostly(false, Just(true)),
        mostly(false, Just(true)),
    );
    let radio = (
        mostly(true, Just(false)),
        mostly(1.0, any::<f32>()),
        mostly((0.0, 0.0), any::<(f32, f32)>()),
    );
    let imu = (
        mostly(true, Just(false)),
        mostly([0.0, 0.0, 9.81], any::<[f32; 3]>()),
        mostly([0.0; 3], any::<[f32; 3]>()),
        mostly([0.0; 3], any::<[f32; 3]>()),
        mostly([0.0, 20.0, -45.0], any::<[f32; 3]>()),
        mostly(true, Just(false)),
    );
    let rest = (
        mostly(BusErrorState::Active, Just(BusErrorState::BusOff)),
        mostly(true, Just(false)),
        mostly(None, any::<f32>().prop_map(Some)),
        mostly(0, any::<u32>()),
        mostly(0, any::<u64>()),
        (any::<u16>(), prop::collection::vec(any::<u8>(), 0..=8)),
    );
    let phase =
        (1u16..300, switches, radio, imu, rest).prop_map(|(ticks, switches, radio, imu, rest)| {
            Phase {
                ticks,
                enabled: switches.0,
                e_stop: switches.1,
                failsafe: switches.2,
                radio_sends: radio.0,
                quality: radio.1,
                sticks: radio.2,
                imu_sends: imu.0,
                accel: imu.1,
                gyro: imu.2,
                gyro_bias: imu.3,
                mag: imu.4,
                calibrated: imu.5,
                can1: rest.0,
                logic_sends: rest.1,
                direct_ma: rest.2,
                imu_errors: rest.3,
                time_jump_us: rest.4,
                frame: rest.5,
            }
        });
    prop::collection::vec(phase, 1..12)
}

/// Everything in order.
pub fn good(ticks: u16, enabled: bool) -> Phase {
    Phase {
        ticks,
        enabled,
        e_stop: false,
        failsafe: false,
        radio_sends: true,
        quality: 1.0,
        sticks: (0.0, 0.0),
        imu_sends: true,
        accel: [0.0, 0.0, 9.81],
        gyro: [0.0; 3],
        gyro_bias: [0.0; 3],
        mag: [0.0, 20.0, -45.0],
        calibrated: true,
        can1: BusErrorState::Active,
        logic_sends: true,
        direct_ma: None,
        imu_errors: 0,
        time_jump_us: 0,
        frame: (0x201, vec![0; 8]),
    }
}

/// The latest snapshot of each producer, as the tasks around the control tick keep them.
#[derive(Default)]
pub struct Producers {
    remote: RemoteUpdate,
    imu: ImuState,
    mag: MagState,
    logic: LogicBus,
    health: SystemHealth,
}

impl Producers {
    pub fn run(&mut self, phase: &Phase, tick: u16, now_us: u64) {
        if phase.radio_sends && tick.is_multiple_of(7) {
            self.remote = remote_update(phase, now_us);
        }
        if phase.imu_sends && tick.is_multiple_of(5) {
            self.imu = ImuState {
                accel_mps2: phase.accel,
                gyro_dps: phase.gyro,
                gyro_bias_dps: phase.gyro_bias,
                ts_us: now_us,
                ..ImuState::default()
            };
        }
        if tick.is_multiple_of(20) {
            self.mag = MagState {
                mag_ut: phase.mag,
                ts_us: now_us,
            };
        }
        if phase.logic_sends && tick.is_multiple_of(10) {
            let (vx, wz) = phase.sticks;
            self.logic = LogicBus {
                hl_cmd: HighLevelCommand { vx, wz },
                hl_valid: true,
                cmd: ChassisCommand {
                    wheels: [WheelCommand {
                        current_ma: phase.direct_ma.unwrap_or_default(),
                    }; 2],
                    ..ChassisCommand::default()
                },
                cmd_valid: phase.direct_ma.is_some(),
                ts_us: now_us,
            };
        }
        self.health.can[0].state = phase.can1;
        self.health.imu_calibrated = phase.calibrated;
        self.health.imu.errors = phase.imu_errors;
    }

    pub fn inputs(&self) -> ControlInputs<'_> {
        ControlInputs {
            remote: &self.remote,
            imu: &self.imu,
            mag: &self.mag,
            logic: &self.logic,
            health: &self.health,
        }
    }
}

fn remote_update(phase: &Phase, now_us: u64) -> RemoteUpdate {
    RemoteUpdate {
        state: RemoteState {
            vx: phase.sticks.0,
            wz: phase.sticks.1,
            ts_us: now_us,
            ..RemoteState::default()
        },
        operator: OperatorState {
            enabled: phase.enabled,
            disabled: !phase.enabled,
            e_stop: phase.e_stop,
            dead_man: false,
            mode: DriveMode::Manual,
            ts_us: now_us,
        },
        diagnostics: RemoteDiagnostics {
            quality: phase.quality,
            frames: 1,
            failsafe: phase.failsafe,
            frame_ts_us: now_us,
            good_ts_us: now_us,
            ..RemoteDiagnostics::default()
        },
    }
}
