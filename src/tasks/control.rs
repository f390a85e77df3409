//! The control task, 1 kHz: CAN frames and snapshots in, CAN frames out. It alone feeds the watchdog.

use embassy_time::{Duration, Instant};
use robot_app::diagnostics::DiagnosticsSnapshot;
use robot_app::domain::FlashRequest;
use robot_app::domain::{BlackBoxStatus, LogicBus};
use robot_app::domain::{
    CalibrationState, LateTasks, LinkHealth, PcCommand, RemoteUpdate, SystemHealth,
};
use robot_app::tick::{ControlInputs, ControlOutputs, DIAGNOSTICS_PERIOD_TICKS, RobotLoop};
use robot_snapshot::{Follower, Writer};

use crate::black_box_memory;
use crate::config::LAYOUT;
use crate::crash_record::{self, LastRun};
use crate::deadlines;
use crate::drivers::analog::AnalogReport;
use crate::drivers::can::CanPort;
use crate::drivers::cycle_jitter::CycleJitter;
use crate::drivers::debug_probe;
use crate::drivers::watchdog::Watchdog;
use crate::exchange::{
    ConfigUpdate, ControlTunnel, ControlWriters, Exchange, FlashPermission, ImuReport, MagReport,
    ParamsReport, RADIO_LINE, REPORT_PULSE, TICK_PULSE,
};
use crate::stall::{StallWatch, SteadyTicker};

const PERIOD: Duration = Duration::from_hz(1_000);

/// What the other tasks publish.
struct Inputs {
    imu: Follower<'static, ImuReport>,
    mag: Follower<'static, MagReport>,
    remote: Follower<'static, RemoteUpdate>,
    logic: Follower<'static, LogicBus>,
    pc: Follower<'static, PcCommand>,
    link: Follower<'static, LinkHealth>,
    analog: Follower<'static, AnalogReport>,
    params: Follower<'static, ParamsReport>,
    black_box: Follower<'static, BlackBoxStatus>,
}

impl Inputs {
    /// Copies newer values and notes the health of the sensors.
    fn follow(&mut self, health: &mut SystemHealth) {
        if let Some(imu) = self.imu.changed() {
            health.imu = imu.health;
            health.imu_status = imu.status;
            health.imu_calibrated = imu.status.calibration.state == CalibrationState::Done;
        }
        if let Some(mag) = self.mag.changed() {
            health.mag = mag.health;
        }
        self.remote.latest();
        self.logic.latest();
        self.pc.latest();
        self.params.latest();
    }

    /// Does the same for what comes at 100 Hz at most and may be 10 ms old.
    fn follow_slow(&mut self, health: &mut SystemHealth) {
        if let Some(analog) = self.analog.changed() {
            health.battery_v = analog.battery_v;
        }
        if let Some(link) = self.link.changed() {
            health.link = *link;
        }
        if let Some(black_box) = self.black_box.changed() {
            health.black_box = *black_box;
        }
    }
}

/// Everything the control tick owns.
pub struct ControlContext {
    inputs: Inputs,
    ports: [CanPort; 2],
    tunnel: ControlTunnel,
    watchdog: Watchdog,
    health: SystemHealth,
    /// Any of `health.late_tasks`.
    late: bool,
    stalls: StallWatch,
    jitter: CycleJitter,
    control_loop: RobotLoop,
    output: Output,
}

/// What this task publishes.
struct Output {
    writers: ControlWriters,
    /// Revision of the configuration that was last published.
    config_revision: u32,
    /// The permission that was last published.
    granted: FlashRequest,
}

impl Output {
    fn publish(&mut self, outputs: &ControlOutputs<'_>) {
        let Self {
            writers,
            config_revision,
            granted,
        } = self;
        let tuning = &outputs.diagnostics.tuning;
        if tuning.revision != *config_revision {
            *config_revision = tuning.revision;
            publish_config(&mut writers.config, outputs);
        }
        if let Some(telemetry) = outputs.telemetry {
            writers.telemetry.publish(telemetry);
        }
        if outputs.flash.granted != *granted {
            *granted = outputs.flash.granted;
            writers.flash_grant.publish(&FlashPermission(*granted));
        }
        if is_diagnostics_tick(outputs.diagnostics) {
            writers.diagnostics.publish(outputs.diagnostics);
            REPORT_PULSE.signal(());
        }
    }
}

/// Out of line, since it is rare and the tick is not.
#[cold]
#[inline(never)]
fn publish_config(writer: &mut Writer<'static, ConfigUpdate>, outputs: &ControlOutputs<'_>) {
    let tuning = &outputs.diagnostics.tuning;
    writer.publish(&ConfigUpdate {
        config: *outputs.config,
        revision: tuning.revision,
        restored: tuning.restored,
    });
}

fn is_diagnostics_tick(diagnostics: &DiagnosticsSnapshot) -> bool {
    diagnostics
        .tick
        .count
        .is_multiple_of(DIAGNOSTICS_PERIOD_TICKS)
}

impl ControlContext {
    pub fn new(
        exchange: &'static Exchange,
        ports: [CanPort; 2],
        tunnel: ControlTunnel,
        watchdog: Watchdog,
        last_run: LastRun,
        writers: ControlWriters,
        debugger_view: &'static mut DiagnosticsSnapshot,
    ) -> Self {
        let mut control_loop =
            RobotLoop::new(&LAYOUT, exchange.config.latest().config, debugger_view);
        control_loop.set_black_box(black_box_memory::memory());
        Self {
            inputs: Inputs {
                imu: exchange.imu.follower(),
                mag: exchange.mag.follower(),
                remote: exchange.remote.follower(),
                logic: exchange.logic_bus.follower(),
                pc: exchange.pc.follower(),
                link: exchange.link.follower(),
                analog: exchange.analog.follower(),
                params: exchange.params.follower(),
                black_box: exchange.black_box.follower(),
            },
            ports,
            tunnel,
            watchdog,
            health: SystemHealth {
                reset_cause: last_run.reset_cause,
                last_words: last_run.crash_cause,
                ..SystemHealth::default()
            },
            late: false,
            stalls: StallWatch::new(),
            jitter: CycleJitter::start(),
            control_loop,
            output: Output {
                writers,
                config_revision: 0,
                granted: FlashRequest::None,
            },
        }
    }
}

/// Borrows the context, because a task would hold one that it owns twice.
#[embassy_executor::task]
pub async fn run(context: &'static mut ControlContext) -> ! {
    let mut ticker = SteadyTicker::every(PERIOD);
    loop {
        ticker.next().await;
        robotapp_control_tick(context);
    }
}

/// One control tick. It has a symbol of its own, so that tools can find its entry.
// SAFETY: no other symbol of the image has this name.
#[unsafe(no_mangle)]
#[inline(never)]
pub fn robotapp_control_tick(context: &mut ControlContext) {
    let now_us = Instant::now().as_micros();
    let ControlContext {
        inputs,
        ports,
        tunnel,
        watchdog,
        health,
        late,
        stalls,
        jitter,
        control_loop,
        output,
    } = context;

    if let Some(stall_us) = stalls.take() {
        jitter.restart();
        ports.iter_mut().for_each(CanPort::drop_backlog);
        control_loop.after_stall(stall_us, now_us);
    }
    jitter.tick();
    for port in ports.iter_mut() {
        port.begin_tick(now_us);
        let bus = port.bus();
        port.drain(|frame, ts_us| control_loop.on_can_frame(bus, frame, ts_us));
    }

    if let Some(request) = tunnel.request() {
        control_loop.on_link_frame(&request, now_us);
    }

    note_late_tasks(late, &mut health.late_tasks, now_us);
    inputs.follow(health);
    for (health, port) in health.can.iter_mut().zip(ports.iter()) {
        *health = *port.health();
    }

    let params = inputs.params.last();
    let tick_inputs = ControlInputs {
        remote: inputs.remote.last(),
        imu: &inputs.imu.last().state,
        mag: &inputs.mag.last().state,
        logic: inputs.logic.last(),
        pc: inputs.pc.last(),
        health,
        params: &params.status,
        flash_request: params.request,
        watchdog: watchdog.period(),
    };
    let outputs = control_loop.tick(&tick_inputs, now_us);

    for (bus, frame) in outputs.frames {
        if let Some(port) = ports.iter_mut().find(|port| port.bus() == *bus) {
            port.send(frame);
        }
    }

    tunnel.reply(outputs.link_frames);

    output.publish(&outputs);
    TICK_PULSE.signal(());
    if is_diagnostics_tick(outputs.diagnostics) {
        inputs.follow_slow(health);
        health.radio_line = RADIO_LINE.health();
        health.max_jitter_cycles = jitter.max_cycles();
        health.debug_probe = debug_probe::undo();
    }
    watchdog.set_long(outputs.flash.needs_long_watchdog);
    if !*late {
        watchdog.feed();
    }
}

/// Notes late tasks, which stop the robot in this tick.
fn note_late_tasks(late: &mut bool, noted: &mut LateTasks, now_us: u64) {
    if deadlines::any_late(now_us) || *late {
        renew_late_tasks(noted, now_us);
        *late = noted.any();
    }
}

/// Logs here, because the status task may be the late one.
#[cold]
#[inline(never)]
fn renew_late_tasks(noted: &mut LateTasks, now_us: u64) {
    let late = deadlines::late_tasks(now_us);
    if late == *noted {
        return;
    }
    *noted = late;
    // SAFETY: called by the control tick alone.
    unsafe { crash_record::write(late.crash_cause()) };
    if late.any() {
        defmt::error!("{}, waiting for the watchdog", late.crash_cause());
    }
}
