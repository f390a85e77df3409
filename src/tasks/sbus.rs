//! The radio task: decodes the bytes of the receiver as each frame arrives.

use embassy_time::{Duration, Instant, with_timeout};
use robot_app::domain::RemoteUpdate;
use robot_app::input::{RemoteFormat, RemoteReceiver};
use robot_snapshot::Writer;

use crate::deadlines::Watched;
use crate::drivers::radio_uart::{Burst, RadioUart};
use crate::exchange::Exchange;

/// Longest wait for bytes. Silence is no error here, since the age of the last frame shows it, but the task must check in.
const CHECK_IN_PERIOD: Duration = Duration::from_millis(10);

#[embassy_executor::task]
pub async fn run(
    mut uart: RadioUart,
    format: RemoteFormat,
    exchange: &'static Exchange,
    mut output: Writer<'static, RemoteUpdate>,
) -> ! {
    let mut settings = exchange.config.follower();
    let mut receiver = RemoteReceiver::new(format, settings.last().config.radio);
    let mut bytes = [0; 64];
    loop {
        if let Ok(burst) = with_timeout(CHECK_IN_PERIOD, uart.read(&mut bytes)).await {
            let ts_us = Instant::now().as_micros();
            match burst {
                Burst::Clean(arrived) => {
                    if let Some(update) = settings.changed() {
                        receiver.set_mapping(&update.config.radio);
                    }
                    receiver.feed(arrived, ts_us, |update| output.publish(&update));
                }
                Burst::Damaged { count } => receiver.reject(count, ts_us),
            }
        }
        Watched::Sbus.check_in();
    }
}
