//! The IMU task, 200 Hz: samples of the BMI088, calibrated, and its heater. A lost sensor is brought up again until it works.

use embassy_time::{Duration, Instant};
use robot_app::sensing::ImuPipeline;
use robot_snapshot::Writer;

use crate::board::ImuBus;
use crate::deadlines::{Watched, sleep_checking_in};
use crate::drivers::bmi088::Bmi088;
use crate::drivers::heater::Heater;
use crate::exchange::{Exchange, ImuReport};
use crate::stall::SteadyTicker;

const PERIOD: Duration = Duration::from_hz(200);
/// Bad samples in a row after which the sensor counts as lost.
const LOST_AFTER: u32 = 5;
const RETRY_PAUSE: Duration = Duration::from_millis(100);

struct ImuTask {
    exchange: &'static Exchange,
    pipeline: ImuPipeline,
    heater: Heater,
    report: ImuReport,
    output: Writer<'static, ImuReport>,
}

#[embassy_executor::task]
pub async fn run(
    mut bus: ImuBus,
    heater: Heater,
    exchange: &'static Exchange,
    output: Writer<'static, ImuReport>,
) -> ! {
    let config = exchange.config.latest().config;
    let mut task = ImuTask {
        exchange,
        pipeline: ImuPipeline::new(config.imu, config.heater),
        heater,
        report: ImuReport::default(),
        output,
    };
    loop {
        let mut sensor = bus.open();
        if sensor.bring_up().await.is_ok() {
            task.sample_until_lost(&mut sensor).await;
        } else {
            task.report.health.count_error();
        }
        task.report.health.count_loss();
        task.publish();
        sleep_checking_in(Watched::Imu, RETRY_PAUSE).await;
    }
}

impl ImuTask {
    async fn sample_until_lost(&mut self, sensor: &mut Bmi088<'_>) {
        let mut ticker = SteadyTicker::every(PERIOD);
        let mut bad_in_row: u32 = 0;
        while bad_in_row < LOST_AFTER {
            ticker.next().await;
            Watched::Imu.check_in();
            let config = self.exchange.config.latest().config;
            self.pipeline.set_mounting(config.mounting.board);
            self.pipeline.set_config(&config.imu, &config.heater);
            if self.sample(sensor).await {
                bad_in_row = 0;
            } else {
                bad_in_row = bad_in_row.saturating_add(1);
            }
        }
    }

    /// Reads and publishes one sample; false if there was none, which also turns the heater off.
    async fn sample(&mut self, sensor: &mut Bmi088<'_>) -> bool {
        let read_us = Instant::now().as_micros();
        let state = if let Ok(answers) = sensor.read_sample().await {
            self.pipeline
                .process(
                    &answers.accel,
                    &answers.gyro,
                    answers.gyro_frames(),
                    read_us,
                )
                .ok()
        } else {
            self.pipeline.process_silence(read_us);
            None
        };
        self.heater.set_duty(self.pipeline.heater_duty());
        if let Some(state) = state {
            self.report.state = state;
            self.report.health.count_sample();
        } else {
            self.report.health.count_error();
        }
        self.publish();
        if self.pipeline.take_buffer_reset() && sensor.reset_gyro_buffer().await.is_err() {
            self.report.health.count_error();
        }
        state.is_some()
    }

    fn publish(&mut self) {
        self.report.status = self.pipeline.status();
        self.output.publish(&self.report);
    }
}
