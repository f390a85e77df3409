//! The receiving half of the PC link: commands of the PC, and requests for the tuning channel.
//!
//! The task takes bytes every millisecond, and once more in each when the line falls idle. So a command waits for no
//! more than a task switch, and no line, whatever it carries, runs the task more than 2,000 times a second.

use embassy_time::{Duration, Instant, Timer, with_deadline};
use robot_app::domain::{LinkHealth, PcCommand};
use robot_app::link::{Received, RobotReceiver};
use robot_snapshot::Writer;

use crate::board::serial::LinkReceiver;
use crate::deadlines::Watched;
use crate::exchange::{Exchange, Tunnel, TunnelRequests};
use crate::stall::next_due;

const PERIOD: Duration = Duration::from_hz(1_000);
/// Periods between two reports about the link, 10 ms.
const HEALTH_DIVIDER: u32 = 10;

/// Where this task writes to.
pub struct LinkWriters {
    pub pc: Writer<'static, PcCommand>,
    pub health: Writer<'static, LinkHealth>,
    pub requests: TunnelRequests,
}

#[embassy_executor::task]
pub async fn run(
    mut uart: LinkReceiver,
    exchange: &'static Exchange,
    mut output: LinkWriters,
) -> ! {
    let mut receiver = RobotReceiver::new();
    let mut due = Instant::now();
    let mut round: u32 = 0;
    loop {
        if with_deadline(due, uart.wait()).await.is_ok() {
            receive(&mut uart, &mut receiver, &mut output);
            Timer::at(due).await;
        }
        receive(&mut uart, &mut receiver, &mut output);
        Watched::LinkReceive.check_in();
        due = next_due(due, PERIOD);
        round = round.wrapping_add(1);
        if round.is_multiple_of(HEALTH_DIVIDER) {
            output.health.publish(&LinkHealth {
                sent: exchange.frames_sent.latest(),
                tunnel_dropped: Tunnel::dropped(),
                ..receiver.health(Instant::now().as_micros())
            });
        }
    }
}

fn receive(uart: &mut LinkReceiver, receiver: &mut RobotReceiver, output: &mut LinkWriters) {
    let LinkWriters { pc, requests, .. } = output;
    let ts_us = Instant::now().as_micros();
    uart.take(|burst| {
        if burst.errors > 0 {
            receiver.count_line_errors(burst.errors);
        }
        receiver.feed(burst.bytes, ts_us, |received| match received {
            Received::Command(command) => pc.publish(&command),
            Received::Tunnel(request) => requests.push(request),
        });
    });
}
