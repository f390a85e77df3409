//! 200 Hz: BMI088 → calibrated IMU samples. A lost sensor is brought up again for as long as it takes.

use embassy_time::{Duration, Instant, Ticker};
use robot_app::sensing::ImuPipeline;
use robot_snapshot::Writer;

use crate::board::ImuBus;
use crate::deadlines::{Watched, sleep_checking_in};
use crate::drivers::bmi088::Bmi088;
use crate::exchange::{Exchange, ImuReport};

const PERIOD: Duration = Duration::from_hz(200);
/// Bad samples in a row after which the sensor counts as lost.
const LOST_AFTER: u32 = 5;
const RETRY_PAUSE: Duration = Duration::from_millis(100);

struct ImuTask {
    pipeline: ImuPipeline,
    report: ImuReport,
    output: Writer<'static, ImuReport>,
}

#[embassy_executor::task]
pub async fn run(
    mut bus: ImuBus,
    exchange: &'static Exchange,
    output: Writer<'static, ImuReport>,
) -> ! {
    let mut task = ImuTask {
        pipeline: ImuPipeline::new(exchange.config.latest().imu),
        report: ImuReport::default(),
        output,
    };
    loop {
        let mut sensor = bus.open();
        if sensor.bring_up().await.is_ok() {
            task.sample_until_lost(&mut sensor).await;
        } else {
            task.count_error();
        }
        task.report.health.reinits = task.report.health.reinits.wrapping_add(1);
        task.publish_ready(false);
        sleep_checking_in(Watched::Imu, RETRY_PAUSE).await;
    }
}

impl ImuTask {
    async fn sample_until_lost(&mut self, sensor: &mut Bmi088<'_>) {
        let mut ticker = Ticker::every(PERIOD);
        let mut bad_in_row = 0;
        while bad_in_row < LOST_AFTER {
            ticker.next().await;
            Watched::Imu.check_in();
            if self.sample(sensor).await {
                bad_in_row = 0;
            } else {
                bad_in_row = bad_in_row.saturating_add(1);
            }
        }
    }

    /// Reads and publishes one sample; false if there was none.
    async fn sample(&mut self, sensor: &mut Bmi088<'_>) -> bool {
        let ts_us = Instant::now().as_micros();
        let state = match sensor.read_sample().await {
            Ok(answers) => self
                .pipeline
                .process(&answers.accel, &answers.gyro, ts_us)
                .ok(),
            Err(_) => None,
        };
        if let Some(state) = state {
            self.report.state = state;
            self.report.calibrated = self.pipeline.calibrated();
            self.report.health.samples = self.report.health.samples.wrapping_add(1);
            self.publish_ready(true);
        } else {
            self.count_error();
            self.output.publish(&self.report);
        }
        state.is_some()
    }

    fn count_error(&mut self) {
        self.report.health.errors = self.report.health.errors.wrapping_add(1);
    }

    fn publish_ready(&mut self, ready: bool) {
        self.report.health.ready = ready;
        self.output.publish(&self.report);
    }
}
