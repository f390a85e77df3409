//! The sending half of the PC link: the robot's state at 417 Hz, and replies of the tuning channel, which come first.

use embassy_time::{Duration, Instant, Timer, with_deadline};
use robot_app::link::{Observation, Tunnelled, Uplink};
use robot_snapshot::Writer;

use crate::board::serial::LinkTransmitter;
use crate::deadlines::Watched;
use crate::exchange::{Exchange, TunnelReplies};

/// A state frame takes 2.04 ms, so that a reply of 0.26 ms fits between two of them.
const PERIOD: Duration = Duration::from_micros(2_400);
/// Period of the control tick.
const TICK_US: u64 = 1_000;
/// Time from a control tick to the frame after it. With the period above, every later frame begins an odd multiple of
/// this after a tick. A timer that ends together with the tick's would delay its release.
const AFTER_TICK: Duration = Duration::from_micros(100);
/// Time to the first frame. The control task has published its state by then.
const FIRST_STATE: Duration = Duration::from_millis(5);

#[embassy_executor::task]
pub async fn run(
    mut uart: LinkTransmitter,
    exchange: &'static Exchange,
    mut replies: TunnelReplies,
    mut frames_sent: Writer<'static, u32>,
) -> ! {
    let mut sent: u32 = 0;
    Timer::after(FIRST_STATE).await;
    let mut due = after_a_tick(exchange);
    loop {
        match with_deadline(due, replies.next()).await {
            Ok(reply) => {
                if let Some(frame) = Tunnelled::new(reply) {
                    uart.send(&frame.encode()).await;
                }
            }
            Err(_) => {
                uart.send(&state(exchange).encode()).await;
                due = next_due(due, exchange);
                sent = sent.wrapping_add(1);
                frames_sent.publish(&sent);
            }
        }
        Watched::LinkSend.check_in();
    }
}

/// The end of the period that begins at `due`. After a stall that is over, and the frames begin anew.
fn next_due(due: Instant, exchange: &'static Exchange) -> Instant {
    let next = due.saturating_add(PERIOD);
    if next > Instant::now() {
        next
    } else {
        after_a_tick(exchange)
    }
}

/// The time of the first frame after the next control tick.
fn after_a_tick(exchange: &'static Exchange) -> Instant {
    let now_us = Instant::now().as_micros();
    let since_us = now_us.saturating_sub(exchange.telemetry.latest().ts_us) % TICK_US;
    let tick_us = now_us.saturating_sub(since_us).saturating_add(TICK_US);
    Instant::from_micros(tick_us).saturating_add(AFTER_TICK)
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
