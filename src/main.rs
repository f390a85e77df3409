//! Firmware of the wheel-legged robot on a RoboMaster Development Board C.
//!
//! The logic is in `robot_app`; here are clocks, pins, drivers and the tasks that carry data between them.
//! `exchange.rs` shows the data flow, `board.rs` the hardware, `fault.rs` what happens when all else fails.

#![no_std]
#![no_main]
#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    clippy::arithmetic_side_effects,
    clippy::undocumented_unsafe_blocks,
    clippy::multiple_unsafe_ops_per_block
)]

mod black_box_memory;
mod board;
mod config;
mod crash_record;
mod deadlines;
mod debugger_view;
mod drivers;
mod exchange;
mod executors;
mod fault;
mod isr_cell;
mod robot_identity;
mod stall;
mod tasks;

use defmt_rtt as _;
use embassy_executor::{Executor, Spawner};
use embassy_time::{Duration, Instant};
use robot_app::domain::{CrashCause, ResetCause, RobotConfig};
use robot_app::params::ParamService;
use static_cell::StaticCell;

use board::Board;
use crash_record::LastRun;
use drivers::can::CanPort;
use drivers::debug_probe;
use drivers::param_flash::ParamFlash;
use drivers::reset_cause;
use drivers::watchdog::Watchdog;
use exchange::{Exchange, Tunnel};
use tasks::control::ControlContext;
use tasks::link_receive::LinkWriters;

/// Longest wait for an idle bus. A working bus is idle for 11 bits within one frame of at most 0.14 ms, and a dead one must
/// not stop the boot.
const CAN_JOIN_TIMEOUT: Duration = Duration::from_millis(1);
/// Longest time for the safe frames. Five frames on one bus take 0.7 ms.
const SAFE_FRAMES_TIMEOUT: Duration = Duration::from_millis(3);

#[cortex_m_rt::entry]
fn main() -> ! {
    debug_probe::undo();
    let last_run = LastRun {
        reset_cause: reset_cause::take(),
        // SAFETY: nothing else runs yet.
        crash_cause: unsafe { crash_record::take() },
    };
    let peripherals = embassy_stm32::init(board::clocks());
    let board = Board::start(peripherals, config::REMOTE_FORMAT);
    let mut ports = [board.can1, board.can2];
    send_zero_torque(&mut ports);
    log_boot(last_run);

    let watchdog = Watchdog::start_long(board.iwdg);
    let (params, config) = load_settings(ParamFlash::new(board.flash));
    ports.iter_mut().for_each(CanPort::drop_backlog);
    let exchange = Exchange::init(config);
    let tunnel = Tunnel::init();
    let writers = defmt::unwrap!(exchange.take_writers());
    deadlines::start();
    static CONTROL: StaticCell<ControlContext> = StaticCell::new();
    let control = CONTROL.init_with(|| {
        ControlContext::new(
            exchange,
            ports,
            tunnel.control,
            watchdog,
            last_run,
            writers.control,
            defmt::unwrap!(debugger_view::take()),
        )
    });

    let sensor = executors::start_sensor(board::SENSOR_EXECUTOR_IRQ);
    sensor.spawn(defmt::unwrap!(tasks::imu::run(
        board.imu,
        board.heater,
        exchange,
        writers.imu
    )));
    sensor.spawn(defmt::unwrap!(tasks::mag::run(
        board.mag,
        exchange,
        writers.mag
    )));
    sensor.spawn(defmt::unwrap!(tasks::sbus::run(
        board.radio,
        config::REMOTE_FORMAT,
        exchange,
        writers.remote
    )));
    executors::start_control(board::CONTROL_EXECUTOR_IRQ)
        .spawn(defmt::unwrap!(tasks::control::run(control)));

    static THREAD_EXECUTOR: StaticCell<Executor> = StaticCell::new();
    THREAD_EXECUTOR
        .init(Executor::new())
        .run(move |spawner: Spawner| {
            spawner.spawn(defmt::unwrap!(tasks::logic::run(
                exchange,
                writers.logic_bus
            )));
            spawner.spawn(defmt::unwrap!(tasks::link_receive::run(
                board.link.receiver,
                exchange,
                LinkWriters {
                    pc: writers.pc,
                    health: writers.link,
                    requests: tunnel.receive,
                }
            )));
            spawner.spawn(defmt::unwrap!(tasks::link_send::run(
                board.link.transmitter,
                exchange,
                tunnel.send,
                writers.frames_sent
            )));
            spawner.spawn(defmt::unwrap!(tasks::params::run(
                params,
                exchange,
                writers.params
            )));
            spawner.spawn(defmt::unwrap!(tasks::black_box::run(
                last_run,
                exchange,
                writers.black_box
            )));
            spawner.spawn(defmt::unwrap!(tasks::status::run(
                exchange,
                board.led,
                board.buzzer,
                board.analog,
                writers.analog
            )));
        })
}

/// Loads the settings from flash. It programs a few words at most, because motors may still be turning.
fn load_settings(flash: ParamFlash) -> (ParamService<ParamFlash>, RobotConfig) {
    let start = Instant::now();
    let (mut service, config) = ParamService::boot(flash, &config::LAYOUT);
    service.note_boot(start.elapsed().as_micros() as u32);
    let status = service.status();
    defmt::info!(
        "settings: {=u32} groups from flash, {=u32} refused, {=u16} foreign, {=u16} damaged places, {=u32} us",
        status.loaded.count_ones(),
        status.refused.count_ones(),
        status.foreign,
        status.damaged,
        status.boot_us
    );
    if status.lost_sectors != 0 {
        defmt::error!(
            "settings: {=u8} ruined flash sectors, newer settings may be lost: check them all",
            status.lost_sectors
        );
    }
    if status.strange_sectors != 0 {
        defmt::info!(
            "settings: {=u8} flash sectors hold something else, such as an older firmware",
            status.strange_sectors
        );
    }
    (service, config)
}

fn log_boot(last_run: LastRun) {
    let LastRun {
        reset_cause,
        crash_cause,
    } = last_run;
    match (reset_cause, crash_cause) {
        (ResetCause::IndependentWatchdog, CrashCause::Silent) => {
            defmt::error!("boot, reset by watchdog: the control tick hung");
        }
        (cause, CrashCause::Silent) => defmt::info!("boot, reset cause {}", cause),
        (reset, crash) => defmt::error!("boot, reset cause {}: {}", reset, crash),
    }
}

/// Stops motors that were left turning, before anything else starts.
fn send_zero_torque(ports: &mut [CanPort; 2]) {
    let start = Instant::now();
    while ports.iter().any(|port| !port.is_on_bus()) && start.elapsed() < CAN_JOIN_TIMEOUT {
        for port in ports.iter_mut() {
            port.begin_tick(Instant::now().as_micros());
        }
    }
    for (bus, frame) in &config::SAFE_FRAMES {
        for port in ports.iter_mut().filter(|port| port.bus() == *bus) {
            while !port.has_room() && start.elapsed() < SAFE_FRAMES_TIMEOUT {}
            port.send(frame);
        }
    }
}
