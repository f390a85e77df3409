//! The magnetometer task, 50 Hz: samples of the IST8310, calibrated. A lost sensor is brought up again until it works.

use embassy_time::{Duration, Instant};
use robot_app::sensing::MagPipeline;
use robot_snapshot::Writer;

use crate::board::MagBus;
use crate::deadlines::{Watched, sleep_checking_in};
use crate::drivers::ist8310::Ist8310;
use crate::exchange::{Exchange, MagReport};
use crate::stall::SteadyTicker;

/// Half of the 50 Hz period, so that the task can check in between.
const HALF_PERIOD: Duration = Duration::from_millis(10);
/// Bad samples in a row after which the sensor counts as lost.
const LOST_AFTER: u32 = 5;
const RETRY_PAUSE: Duration = Duration::from_millis(200);

struct MagTask {
    exchange: &'static Exchange,
    pipeline: MagPipeline,
    report: MagReport,
    output: Writer<'static, MagReport>,
}

#[embassy_executor::task]
pub async fn run(
    mut bus: MagBus,
    exchange: &'static Exchange,
    output: Writer<'static, MagReport>,
) -> ! {
    let mut task = MagTask {
        exchange,
        pipeline: MagPipeline::new(exchange.config.latest().config.mag),
        report: MagReport::default(),
        output,
    };
    loop {
        let mut sensor = bus.open();
        if sensor.bring_up().await.is_ok() {
            task.log_if_unused();
            task.sample_until_lost(&mut sensor).await;
        } else {
            task.report.health.count_error();
        }
        task.report.health.count_loss();
        task.output.publish(&task.report);
        sleep_checking_in(Watched::Mag, RETRY_PAUSE).await;
    }
}

impl MagTask {
    fn log_if_unused(&self) {
        if self.exchange.config.latest().config.mounting.mag.is_none() {
            defmt::info!("the heading goes without the magnetometer: mounting.mag is unset");
        }
    }

    async fn sample_until_lost(&mut self, sensor: &mut Ist8310<'_>) {
        let mut ticker = SteadyTicker::every(HALF_PERIOD);
        let mut bad_in_row: u32 = 0;
        while bad_in_row < LOST_AFTER {
            ticker.next().await;
            Watched::Mag.check_in();
            let config = self.exchange.config.latest().config;
            self.pipeline.set_mounting(&config.mounting);
            self.pipeline.set_calibration(&config.mag);
            if self.sample(sensor).await {
                bad_in_row = 0;
            } else {
                bad_in_row = bad_in_row.saturating_add(1);
            }
            ticker.next().await;
            Watched::Mag.check_in();
        }
    }

    /// Measures and publishes one sample; false if there was none.
    async fn sample(&mut self, sensor: &mut Ist8310<'_>) -> bool {
        let started_us = Instant::now().as_micros();
        let state = match sensor.measure().await {
            Ok(answer) => self.pipeline.process(&answer, started_us).ok(),
            Err(_) => None,
        };
        if let Some(state) = state {
            self.report.state = state;
            self.report.health.count_sample();
        } else {
            self.report.health.count_error();
        }
        self.output.publish(&self.report);
        state.is_some()
    }
}
