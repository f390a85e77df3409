//! The radio task: decodes the bytes of the receiver as each frame arrives.

use embassy_time::{Duration, Instant, with_timeout};
use robot_app::domain::RemoteUpdate;
use robot_app::input::{RemoteFormat, RemoteReceiver};
use robot_snapshot::Writer;

use crate::board::serial::RadioReceiver;
use crate::deadlines::Watched;
use crate::exchange::Exchange;

/// Longest wait for bytes. Silence is no error here, since the age of the last frame shows it, but the task must check in.
const CHECK_IN_PERIOD: Duration = Duration::from_millis(10);

#[embassy_executor::task]
pub async fn run(
    mut uart: RadioReceiver,
    format: RemoteFormat,
    exchange: &'static Exchange,
    mut output: Writer<'static, RemoteUpdate>,
) -> ! {
    let mut settings = exchange.config.follower();
    let mut receiver = RemoteReceiver::new(format, settings.last().config.radio);
    loop {
        if with_timeout(CHECK_IN_PERIOD, uart.wait()).await.is_ok() {
            let ts_us = Instant::now().as_micros();
            uart.take(|burst| {
                if burst.errors > 0 {
                    receiver.reject(burst.bytes.len(), ts_us);
                } else if !burst.bytes.is_empty() {
                    if let Some(update) = settings.changed() {
                        receiver.set_mapping(&update.config.radio);
                    }
                    receiver.feed(burst.bytes, ts_us, |update| output.publish(&update));
                }
            });
        }
        Watched::Sbus.check_in();
    }
}
