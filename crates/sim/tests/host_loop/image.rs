//! The image in the emulated board, with what each of its ticks got and decided.

use std::sync::OnceLock;

use robot_app::domain::{
    BusErrorState, BusHealth, BusId, CanFrame, DebugProbe, DriveMode, HighLevelCommand, ImuRejects,
    ImuState, LogicBus, MagState, OperatorState, ParamStatus, RemoteDiagnostics, RemoteState,
    RemoteUpdate, ResetCause, SensorHealth, StandSwitch, StandardId, SystemHealth,
};
use robot_plant::time::{MS, Ps, US};
use robot_sim::machine::Machine;

use crate::{
    course::{self, Moment},
    numbers::Numbers,
};

/// The static that holds everything of the control tick.
const TICK: &str = "__cortex_m_rt_main::CONTROL";
/// By which a tick is over.
const TICK_TAKES: Ps = 700 * US;

/// What a tick of the image got.
#[derive(Default)]
pub struct Inputs {
    pub now_us: u64,
    /// How long the chip had stood still for an erase of its flash. What came meanwhile is dropped.
    pub stall_us: Option<u32>,
    pub frames: Vec<(BusId, CanFrame, u64)>,
    pub remote: RemoteUpdate,
    pub imu: ImuState,
    pub mag: MagState,
    pub logic: LogicBus,
    pub health: SystemHealth,
    pub params: ParamStatus,
}

/// A queue of received frames. What a tick has taken stays in its place until the queue comes round to it.
struct Queue {
    bus: BusId,
    frame: Numbers,
    next: Numbers,
    taken: u32,
}

/// Places in a queue.
const QUEUE_LEN: u32 = 32;

impl Queue {
    fn new(bus: BusId, statik: &str) -> Self {
        Self {
            bus,
            frame: Numbers::of(statik, "ReceivedFrame"),
            next: Numbers::of(statik, "AtomicUsize"),
            taken: 0,
        }
    }

    /// The frames taken since the last call.
    fn take(&mut self, machine: &Machine, frames: &mut Vec<(BusId, CanFrame, u64)>) {
        self.next.read(machine, 0);
        let next = self.next.u32("v.value");
        while self.taken != next {
            self.frame.read(machine, self.taken);
            let data: [u8; 8] = std::array::from_fn(|n| self.frame.u8(&format!("frame.data.{n}")));
            let id = StandardId::new(self.frame.u16("frame.id")).expect("11 bits");
            let len = usize::from(self.frame.u8("frame.len"));
            let frame = CanFrame::from_payload(id, &data[..len]).expect("8 bytes at most");
            frames.push((self.bus, frame, self.frame.u64("ts_us")));
            self.taken = (self.taken + 1) % QUEUE_LEN;
        }
    }
}

/// A tick of the image.
pub struct Tick {
    pub inputs: Inputs,
    /// What it decided, by the names of the report.
    pub outputs: Vec<f64>,
}

/// The run of the image.
pub struct Run {
    pub ticks: Vec<Tick>,
    pub moments: Vec<Moment>,
}

/// The run of the image, which both tests look at. `outputs` are the names of what is kept of each report.
pub fn run(outputs: &[String]) -> &'static Run {
    static RUN: OnceLock<Run> = OnceLock::new();
    RUN.get_or_init(|| {
        let mut image = Image::start();
        let mut ticks = Vec::new();
        while image.machine.now() < course::ENDS_AT {
            let inputs = image.tick();
            let outputs = outputs.iter().map(|name| image.report.get(name)).collect();
            ticks.push(Tick { inputs, outputs });
        }
        Run {
            ticks,
            moments: image.moments,
        }
    })
}

/// The image, stopped after each tick.
struct Image {
    machine: Machine,
    next_event: usize,
    events: [(Ps, course::Event); 5],
    queues: [Queue; 4],
    remote: Numbers,
    imu: Numbers,
    mag: Numbers,
    logic: Numbers,
    health: Numbers,
    params: Numbers,
    /// The report of the last tick.
    report: Numbers,
    /// As the tick before left it.
    slow_health: SystemHealth,
    ticks: u32,
    stalls: u32,
    moments: Vec<Moment>,
}

impl Image {
    /// Powers the board on.
    fn start() -> Self {
        let world = course::world().expect("no recording to load");
        let of_tick = |record| Numbers::of(TICK, record);
        Self {
            machine: Machine::new(&robot_test_support::image(), world).expect("the image starts"),
            next_event: 0,
            events: course::events(),
            queues: [
                Queue::new(BusId::Can1, "receive::CAN1_FIFO0"),
                Queue::new(BusId::Can1, "receive::CAN1_FIFO1"),
                Queue::new(BusId::Can2, "receive::CAN2_FIFO0"),
                Queue::new(BusId::Can2, "receive::CAN2_FIFO1"),
            ],
            remote: of_tick("RemoteUpdate"),
            imu: of_tick("ImuReport"),
            mag: of_tick("MagReport"),
            logic: of_tick("LogicBus"),
            health: of_tick("SystemHealth"),
            params: of_tick("ParamStatus"),
            report: Numbers::of("g_robotapp_diag", "DiagnosticsSnapshot"),
            slow_health: SystemHealth::default(),
            ticks: 0,
            stalls: 0,
            moments: Vec::new(),
        }
    }

    /// Runs until the next tick is over, and tells what it got.
    fn tick(&mut self) -> Inputs {
        let before = self.machine.progress().ticks;
        let mut until = before.map_or(0, |(_, began)| began + MS);
        while self.machine.progress().ticks == before {
            self.run_until(until);
            until += 100 * US;
        }
        self.run_until(until + TICK_TAKES);
        self.report.read(&self.machine, 0);
        self.ticks += 1;
        let count = self.report.u32("tick.count");
        assert_eq!(count, self.ticks, "a tick was not seen");
        self.inputs()
    }

    /// Runs, and stops for what happens and for the moments to keep.
    fn run_until(&mut self, until: Ps) {
        loop {
            let event = self.events.get(self.next_event).map_or(Ps::MAX, |it| it.0);
            let moment = course::moment_at(self.moments.len());
            let stop = until.min(event).min(moment);
            self.machine.run_until(stop).expect("the image runs");
            if stop == moment {
                let moment = self.machine.with_world(|world| Moment::of(world));
                self.moments.push(moment);
            }
            if stop == event {
                let (_, event) = &self.events[self.next_event];
                self.machine.with_world(|world| event.happen(world));
                self.next_event += 1;
            }
            if stop == until {
                return;
            }
        }
    }

    fn inputs(&mut self) -> Inputs {
        let mut frames = Vec::new();
        for queue in &mut self.queues {
            queue.take(&self.machine, &mut frames);
        }
        let stalls = self.report.u32("tick.stalls");
        let stalled = std::mem::replace(&mut self.stalls, stalls) != stalls;
        if stalled {
            frames.clear();
        }
        for numbers in [
            &mut self.remote,
            &mut self.imu,
            &mut self.mag,
            &mut self.logic,
            &mut self.health,
            &mut self.params,
        ] {
            numbers.read(&self.machine, 0);
        }
        let before = std::mem::replace(&mut self.slow_health, slow_health(&self.health));
        Inputs {
            now_us: self.report.u64("ts_us"),
            stall_us: stalled.then(|| self.report.u32("tick.longest_stall_us")),
            frames,
            remote: remote(&self.remote),
            imu: imu(&self.imu),
            mag: MagState {
                mag_ut: self.mag.f32s("state.mag_ut"),
                ts_us: self.mag.u64("state.ts_us"),
            },
            logic: logic(&self.logic),
            health: health(&self.health, before),
            params: ParamStatus {
                revision: self.params.u32("revision"),
                seen: self.params.u32("seen"),
                ..ParamStatus::default()
            },
        }
    }
}

fn remote(it: &Numbers) -> RemoteUpdate {
    RemoteUpdate {
        state: RemoteState {
            channels: it.f32s("state.channels"),
            vx: it.f32("state.vx"),
            wz: it.f32("state.wz"),
            select: it.f32("state.select"),
            hold: it.f32("state.hold"),
            height: it.f32("state.height"),
            roll: it.f32("state.roll"),
            ts_us: it.u64("state.ts_us"),
        },
        operator: OperatorState {
            enabled: it.flag("operator.enabled"),
            disabled: it.flag("operator.disabled"),
            e_stop: it.flag("operator.e_stop"),
            dead_man: it.flag("operator.dead_man"),
            mode: match it.u8("operator.mode") {
                0 => DriveMode::Manual,
                other => panic!("drive mode {other}"),
            },
            stand: match it.u8("operator.stand") {
                0 => StandSwitch::Unknown,
                1 => StandSwitch::Down,
                _ => StandSwitch::Up,
            },
            jump: it.flag("operator.jump"),
            ts_us: it.u64("operator.ts_us"),
        },
        diagnostics: RemoteDiagnostics {
            frame_rate_hz: it.f32("diagnostics.frame_rate_hz"),
            quality: it.f32("diagnostics.quality"),
            frames: it.u32("diagnostics.frames"),
            lost_frames: it.u32("diagnostics.lost_frames"),
            discarded_bytes: it.u32("diagnostics.discarded_bytes"),
            damaged_bursts: it.u32("diagnostics.damaged_bursts"),
            failsafe: it.flag("diagnostics.failsafe"),
            age_us: it.u32("diagnostics.age_us"),
            frame_ts_us: it.u64("diagnostics.frame_ts_us"),
            good_ts_us: it.u64("diagnostics.good_ts_us"),
        },
        raw: std::array::from_fn(|n| it.u16(&format!("raw.{n}"))),
    }
}

fn imu(it: &Numbers) -> ImuState {
    ImuState {
        accel_mps2: it.f32s("state.accel_mps2"),
        gyro_dps: it.f32s("state.gyro_dps"),
        gyro_bias_dps: it.f32s("state.gyro_bias_dps"),
        temperature_c: it.f32("state.temperature_c"),
        saturated: it.flag("state.saturated"),
        gyro_clipped_ms: std::array::from_fn(|n| it.u8(&format!("state.gyro_clipped_ms.{n}"))),
        ts_us: it.u64("state.ts_us"),
    }
}

/// The user's logic gives no commands of its own here.
fn logic(it: &Numbers) -> LogicBus {
    assert!(!it.flag("cmd_valid") && !it.flag("pc_selected"));
    LogicBus {
        hl_cmd: HighLevelCommand {
            vx: it.f32("hl_cmd.vx"),
            wz: it.f32("hl_cmd.wz"),
            height: it.f32("hl_cmd.height"),
            roll: it.f32("hl_cmd.roll"),
            jump: it.flag("hl_cmd.jump"),
            stand: it.flag("hl_cmd.stand"),
        },
        hl_valid: it.flag("hl_valid"),
        ts_us: it.u64("ts_us"),
        ..LogicBus::default()
    }
}

/// What the tick renews after its work, for the next one.
fn slow_health(it: &Numbers) -> SystemHealth {
    SystemHealth {
        battery_v: it.f32("battery_v"),
        debug_probe: DebugProbe {
            attached: it.flag("debug_probe.attached"),
            catches: it.flag("debug_probe.catches"),
        },
        ..SystemHealth::default()
    }
}

fn health(it: &Numbers, slow: SystemHealth) -> SystemHealth {
    let sensor = |name: &str| SensorHealth {
        ready: it.flag(&format!("{name}.ready")),
        samples: it.u32(&format!("{name}.samples")),
        errors: it.u32(&format!("{name}.errors")),
        reinits: it.u32(&format!("{name}.reinits")),
    };
    let mut health = SystemHealth {
        can: [0, 1].map(|bus| bus_health(it, bus)),
        imu: sensor("imu"),
        mag: sensor("mag"),
        imu_calibrated: it.flag("imu_calibrated"),
        reset_cause: ResetCause::from_code(it.u8("reset_cause")).expect("a cause"),
        ..slow
    };
    health.imu_status.rejects = ImuRejects {
        absent: it.u32("imu_status.rejects.absent"),
        frozen: it.u32("imu_status.rejects.frozen"),
        implausible: it.u32("imu_status.rejects.implausible"),
        saturated: it.u32("imu_status.rejects.saturated"),
        gyro_frames: it.u32("imu_status.rejects.gyro_frames"),
    };
    health
}

fn bus_health(it: &Numbers, bus: usize) -> BusHealth {
    let count = |name: &str| it.u32(&format!("can.{bus}.{name}"));
    assert_eq!(count("state"), BusErrorState::Active as u32);
    BusHealth {
        tx_frames: count("tx_frames"),
        tx_aborted: count("tx_aborted"),
        tx_failures_in_row: count("tx_failures_in_row"),
        rx_frames: count("rx_frames"),
        rx_overruns: count("rx_overruns"),
        rx_queue_full: count("rx_queue_full"),
        bus_off_count: count("bus_off_count"),
        ..BusHealth::default()
    }
}
