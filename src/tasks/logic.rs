//! 100 Hz: remote → high-level command.

use embassy_time::{Duration, Instant, Ticker};
use robot_app::domain::SafetyConfig;
use robot_app::logic::{LogicBus, LogicStage};
use robot_snapshot::Writer;

use crate::deadlines::Watched;
use crate::exchange::Exchange;

const PERIOD: Duration = Duration::from_hz(100);

#[embassy_executor::task]
pub async fn run(exchange: &'static Exchange, mut output: Writer<'static, LogicBus>) -> ! {
    let mut stage = LogicStage::new(&SafetyConfig::default());
    let mut ticker = Ticker::every(PERIOD);
    loop {
        ticker.next().await;
        Watched::Logic.check_in();
        output.publish(&stage.step(&exchange.remote.latest(), Instant::now().as_micros()));
    }
}
