//! 100 Hz: remote, PC or the user's own logic → command on the logic bus.

use embassy_time::{Duration, Instant};
use robot_app::logic::{LogicBus, LogicInputs, LogicStage, UserLogic};
use robot_snapshot::Writer;

use crate::deadlines::Watched;
use crate::exchange::Exchange;
use crate::stall::SteadyTicker;

const PERIOD: Duration = Duration::from_hz(100);

#[embassy_executor::task]
pub async fn run(exchange: &'static Exchange, mut output: Writer<'static, LogicBus>) -> ! {
    let mut stage = LogicStage::new(UserLogic);
    let mut ticker = SteadyTicker::every(PERIOD);
    loop {
        ticker.next().await;
        Watched::Logic.check_in();
        let inputs = LogicInputs {
            config: &exchange.config.latest().config.safety,
            remote: &exchange.remote.latest(),
            pc: None,
            diagnostics: &exchange.diagnostics.latest(),
        };
        output.publish(&stage.step(&inputs, Instant::now().as_micros()));
    }
}
