//! The logic task, 100 Hz: a command from the remote or the user's own logic, or the choice of the PC, to the logic bus.

use embassy_time::{Duration, Instant};
use robot_app::safety::ArmingState;
use robot_app::{
    domain::LogicBus,
    logic::{LogicInputs, LogicStage, UserLogic},
};
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
        let diagnostics = exchange.diagnostics.latest();
        let inputs = LogicInputs {
            config: &exchange.config.latest().config.safety,
            remote: &exchange.remote.latest(),
            sensors: &diagnostics.sensors,
            estimate: &diagnostics.estimate,
            armed: diagnostics.arming.state == ArmingState::Armed,
            battery_v: diagnostics.battery_v,
        };
        output.publish(&stage.step(&inputs, Instant::now().as_micros()));
    }
}
