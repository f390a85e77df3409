//! Radio bytes → remote state, as each frame arrives.

use embassy_time::{Duration, Instant, with_timeout};
use robot_app::domain::RemoteUpdate;
use robot_app::input::{RemoteFormat, RemoteMapping, RemoteReceiver};
use robot_snapshot::Writer;

use crate::deadlines::Watched;
use crate::drivers::radio_uart::RadioUart;

/// Silence is no error here (its age speaks for itself), but the task must show that it lives.
const CHECK_IN_PERIOD: Duration = Duration::from_millis(10);

#[embassy_executor::task]
pub async fn run(
    mut uart: RadioUart,
    format: RemoteFormat,
    mut output: Writer<'static, RemoteUpdate>,
) -> ! {
    let mut receiver = RemoteReceiver::new(format, RemoteMapping::default());
    let mut bytes = [0; 64];
    loop {
        if let Ok(count) = with_timeout(CHECK_IN_PERIOD, uart.read(&mut bytes)).await {
            let arrived = bytes.get(..count).unwrap_or(&bytes);
            let ts_us = Instant::now().as_micros();
            receiver.feed(arrived, ts_us, |update| output.publish(&update));
        }
        Watched::Sbus.check_in();
    }
}
