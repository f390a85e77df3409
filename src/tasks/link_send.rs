//! The sending half of the PC link: the robot's state at 417 Hz, and replies of the tuning channel, which come first.

use embassy_time::{Duration, Instant, with_deadline};
use robot_app::link::{Observation, Tunnelled, Uplink};
use robot_snapshot::Writer;

use crate::board::serial::LinkTransmitter;
use crate::deadlines::Watched;
use crate::exchange::{Exchange, TunnelReplies};
use crate::stall::next_due;

/// A state frame takes 2.04 ms, so that a reply of 0.26 ms fits between two of them.
const PERIOD: Duration = Duration::from_micros(2_400);

#[embassy_executor::task]
pub async fn run(
    mut uart: LinkTransmitter,
    exchange: &'static Exchange,
    mut replies: TunnelReplies,
    mut frames_sent: Writer<'static, u32>,
) -> ! {
    let mut sent: u32 = 0;
    let mut due = Instant::now();
    loop {
        match with_deadline(due, replies.next()).await {
            Ok(reply) => {
                if let Some(frame) = Tunnelled::new(reply) {
                    uart.send(&frame.encode()).await;
                }
            }
            Err(_) => {
                uart.send(&state(exchange).encode()).await;
                due = next_due(due, PERIOD);
                sent = sent.wrapping_add(1);
                frames_sent.publish(&sent);
            }
        }
        Watched::LinkSend.check_in();
    }
}

fn state(exchange: &'static Exchange) -> Uplink {
    let analog = exchange.analog.latest();
    Observation {
        telemetry: &exchange.telemetry.latest(),
        remote: &exchange.remote.latest(),
        wheel_odom: &exchange.config.latest().config.wheel_odom,
        battery_v: analog.battery_v,
        mcu_c: analog.mcu_c,
    }
    .uplink()
}
