//! The parameter task, 1 kHz: saves settings to flash in small steps, each with the control tick's permission.

use embassy_time::{Duration, Instant};
use robot_app::{domain::FlashRequest, params::ParamService};
use robot_snapshot::{Follower, Writer};

use crate::deadlines::Watched;
use crate::drivers::param_flash::ParamFlash;
use crate::exchange::{ConfigUpdate, Exchange, FlashPermission, ParamsReport};
use crate::stall::{StallWatch, SteadyTicker};

const PERIOD: Duration = Duration::from_hz(1_000);
/// Calls of the service per permission: it announces a step in one and takes it in the next.
const STEPS_A_GRANT: u32 = 2;

struct ParamsTask {
    service: ParamService<ParamFlash>,
    config: Follower<'static, ConfigUpdate>,
    grant: Follower<'static, FlashPermission>,
    stalls: StallWatch,
    asked: FlashRequest,
    steps: u32,
    report: ParamsReport,
    output: Writer<'static, ParamsReport>,
}

#[embassy_executor::task]
pub async fn run(
    service: ParamService<ParamFlash>,
    exchange: &'static Exchange,
    output: Writer<'static, ParamsReport>,
) -> ! {
    let mut task = ParamsTask {
        service,
        config: exchange.config.follower(),
        grant: exchange.flash_grant.follower(),
        stalls: StallWatch::new(),
        asked: FlashRequest::None,
        steps: 0,
        report: ParamsReport::default(),
        output,
    };
    let mut ticker = SteadyTicker::every(PERIOD);
    loop {
        ticker.next().await;
        task.step();
        Watched::Params.check_in();
    }
}

impl ParamsTask {
    /// Asks for permission, uses it, withdraws the request, and waits until the permission is gone before it asks again. So
    /// the control tick decides about each step.
    fn step(&mut self) {
        let grant = self.grant.latest().0;
        let granted = if grant == self.asked {
            grant
        } else {
            FlashRequest::None
        };
        let ConfigUpdate {
            config,
            revision,
            restored,
        } = self.config.latest();
        let now_us = Instant::now().as_micros();
        let wanted = self
            .service
            .step(config, *revision, *restored, granted, now_us);
        if let Some(stall_us) = self.stalls.take() {
            self.service.note_stall(stall_us);
            defmt::info!(
                "flash sector erased, the chip stood still for {=u32} us",
                stall_us
            );
        }
        if granted != FlashRequest::None {
            self.steps = self.steps.saturating_add(1);
        }
        if self.steps >= STEPS_A_GRANT {
            self.steps = 0;
            self.asked = FlashRequest::None;
        } else if self.asked != wanted
            && (granted != FlashRequest::None || grant == FlashRequest::None)
        {
            self.asked = wanted;
            self.steps = 0;
        }
        self.publish();
    }

    fn publish(&mut self) {
        let status = self.service.status();
        if self.report.request == self.asked && self.report.status.revision == status.revision {
            return;
        }
        self.report = ParamsReport {
            status: *status,
            request: self.asked,
        };
        self.output.publish(&self.report);
    }
}
