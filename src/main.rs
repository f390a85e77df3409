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
    clippy::arithmetic_side_effects
)]

mod board;
mod config;
mod deadlines;
mod debugger_view;
mod drivers;
mod exchange;
mod executors;
mod fault;
mod isr_cell;
mod tasks;

use defmt_rtt as _;
use embassy_executor::{Executor, Spawner};
use embassy_time::{Duration, Instant};
use robot_app::motor;
use static_cell::StaticCell;

use board::Board;
use drivers::can::CanPort;
use drivers::reset_cause;
use drivers::watchdog::Watchdog;
use exchange::Exchange;
use tasks::control::ControlContext;

/// A bus is idle for 11 bits within one frame time of at most 0.14 ms; a dead bus must not stop the boot.
const CAN_JOIN_TIMEOUT: Duration = Duration::from_millis(1);

#[cortex_m_rt::entry]
fn main() -> ! {
    let reset_cause = reset_cause::take();
    let peripherals = embassy_stm32::init(board::clocks());
    let board = Board::start(peripherals, config::REMOTE_FORMAT);
    let mut ports = [board.can1, board.can2];
    send_zero_torque(&mut ports);
    defmt::info!("boot, reset cause {}", reset_cause);

    let exchange = Exchange::init();
    let writers = defmt::unwrap!(exchange.take_writers());
    deadlines::start();
    let control = ControlContext::new(
        exchange,
        ports,
        Watchdog::start(board.iwdg),
        reset_cause,
        writers.diagnostics,
    );

    let sensor = executors::start_sensor();
    sensor.spawn(defmt::unwrap!(tasks::imu::run(board.imu, writers.imu)));
    sensor.spawn(defmt::unwrap!(tasks::mag::run(board.mag, writers.mag)));
    sensor.spawn(defmt::unwrap!(tasks::sbus::run(
        board.radio,
        config::REMOTE_FORMAT,
        writers.remote
    )));
    executors::start_control().spawn(defmt::unwrap!(tasks::control::run(control)));

    static THREAD_EXECUTOR: StaticCell<Executor> = StaticCell::new();
    THREAD_EXECUTOR
        .init(Executor::new())
        .run(move |spawner: Spawner| {
            spawner.spawn(defmt::unwrap!(tasks::logic::run(
                exchange,
                writers.logic_bus
            )));
            spawner.spawn(defmt::unwrap!(tasks::status::run(
                exchange,
                board.led,
                board.battery,
                writers.battery_v
            )));
        })
}

/// Motors that were left turning by whatever happened before stop before anything else starts.
fn send_zero_torque(ports: &mut [CanPort; 2]) {
    let start = Instant::now();
    while ports.iter().any(|port| !port.is_on_bus()) && start.elapsed() < CAN_JOIN_TIMEOUT {
        for port in ports.iter_mut() {
            port.begin_tick(Instant::now().as_micros());
        }
    }
    for (bus, frame) in motor::safe_frames() {
        for port in ports.iter_mut().filter(|port| port.bus() == bus) {
            port.send(&frame);
        }
    }
}
