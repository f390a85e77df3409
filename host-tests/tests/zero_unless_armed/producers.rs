//! The tasks around the control tick.

use robot_app::{
    domain::{
        CanFrame, ChassisCommand, DriveMode, FlashRequest, HighLevelCommand, ImuState, LogicBus,
        MagState, OperatorState, ParamStatus, PcCommand, RemoteDiagnostics, RemoteState,
        RemoteUpdate, SystemHealth, WheelCommand,
    },
    link::{Received, RobotReceiver},
    safety::WatchdogPeriod,
    tick::ControlInputs,
};

use crate::phase::{Pc, Phase};

/// The latest snapshot of each producer, as the tasks keep them.
#[derive(Default)]
pub struct Producers {
    remote: RemoteUpdate,
    imu: ImuState,
    mag: MagState,
    logic: LogicBus,
    health: SystemHealth,
    params: ParamStatus,
    receiver: RobotReceiver,
    pc: PcCommand,
    /// Requests that came over the PC link.
    pub requests: Vec<CanFrame>,
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
            self.logic = logic_bus(phase, now_us);
        }
        for (bus, health) in self.health.can.iter_mut().enumerate() {
            health.state = phase.buses[bus];
            health.tx_failures_in_row = phase.tx_failures[bus];
        }
        self.receive_from_pc(phase, tick, now_us);
        self.health.late_tasks.mag = phase.late_task;
        self.health.imu_calibrated = phase.calibrated;
        self.health.imu.errors = phase.imu_errors;
        self.health.battery_v = phase.battery_v;
    }

    fn receive_from_pc(&mut self, phase: &Phase, tick: u16, now_us: u64) {
        const BYTES_A_TICK: usize = 46;
        let bytes = match &phase.pc {
            Pc::Repeats(command) if tick.is_multiple_of(10) => command.encode().to_vec(),
            Pc::Silent | Pc::Repeats(_) => Vec::new(),
            Pc::Bytes(bytes) => {
                let sent = BYTES_A_TICK * usize::from(tick);
                let stream = bytes.iter().cycle().skip(sent % bytes.len().max(1));
                stream.take(BYTES_A_TICK).copied().collect()
            }
        };
        let Self {
            receiver,
            pc,
            requests,
            ..
        } = self;
        requests.clear();
        receiver.feed(&bytes, now_us, |received| match received {
            Received::Command(command) => *pc = command,
            Received::Tunnel(frame) => requests.push(frame),
        });
    }

    pub fn inputs(&self) -> ControlInputs<'_> {
        ControlInputs {
            remote: &self.remote,
            imu: &self.imu,
            mag: &self.mag,
            logic: &self.logic,
            pc: &self.pc,
            health: &self.health,
            params: &self.params,
            flash_request: FlashRequest::None,
            watchdog: WatchdogPeriod::Short,
        }
    }
}

fn logic_bus(phase: &Phase, now_us: u64) -> LogicBus {
    let (vx, wz) = phase.sticks;
    let (current_ma, joint) = phase.direct.unwrap_or_default();
    LogicBus {
        hl_cmd: HighLevelCommand {
            vx,
            wz,
            ..HighLevelCommand::default()
        },
        hl_valid: phase.mode != DriveMode::Pc,
        cmd: ChassisCommand {
            wheels: [WheelCommand { current_ma }; 2],
            joints: [joint; 4],
        },
        cmd_valid: phase.direct.is_some(),
        pc_selected: phase.mode == DriveMode::Pc,
        ts_us: now_us,
    }
}

fn remote_update(phase: &Phase, now_us: u64) -> RemoteUpdate {
    RemoteUpdate {
        state: RemoteState {
            channels: phase.channels,
            vx: phase.sticks.0,
            wz: phase.sticks.1,
            select: phase.channels[2],
            hold: phase.channels[3],
            ts_us: now_us,
            ..RemoteState::default()
        },
        operator: OperatorState {
            enabled: phase.enabled,
            disabled: !phase.enabled,
            e_stop: phase.e_stop,
            dead_man: phase.channels[3] > 0.7,
            mode: phase.mode,
            stand: phase.stand,
            ts_us: now_us,
            ..OperatorState::default()
        },
        diagnostics: RemoteDiagnostics {
            quality: phase.quality,
            frames: 1,
            failsafe: phase.failsafe,
            frame_ts_us: now_us,
            good_ts_us: now_us,
            ..RemoteDiagnostics::default()
        },
        ..RemoteUpdate::default()
    }
}
