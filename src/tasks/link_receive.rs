//! The receiving half of the PC link: commands of the PC, and requests for the tuning channel.
//!
//! The task takes bytes after every control tick, and once more in between when the line falls idle. So a command waits for
//! a task switch, or for the next tick at most, and no line, whatever it carries, runs the task more than 2,000 times a
//! second.

use embassy_futures::select::{Either, select};
use embassy_time::Instant;
use robot_app::domain::{LinkHealth, PcCommand};
use robot_app::link::{Received, RobotReceiver};
use robot_snapshot::Writer;

use crate::board::serial::LinkReceiver;
use crate::deadlines::Watched;
use crate::exchange::{Exchange, TICK_PULSE, Tunnel, TunnelRequests};

/// Ticks between two reports about the link, 10 ms.
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
    let mut round: u32 = 0;
    loop {
        if let Either::First(()) = select(uart.wait(), TICK_PULSE.wait()).await {
            receive(&mut uart, &mut receiver, &mut output);
            TICK_PULSE.wait().await;
        }
        receive(&mut uart, &mut receiver, &mut output);
        Watched::LinkReceive.check_in();
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
            return receiver.feed_damaged(burst.bytes, burst.errors, ts_us);
        }
        receiver.feed(burst.bytes, ts_us, |received| match received {
            Received::Command(command) => pc.publish(&command),
            Received::Tunnel(request) => requests.push(request),
        });
    });
}
