//! The status task: LED, buzzer, analogue inputs and the log. It measures at 200 Hz, checks for changes at 100 Hz and
//! logs a summary at 4 Hz.

use embassy_time::{Duration, Instant};
use robot_app::diagnostics::DiagnosticsSnapshot;
use robot_app::indication::{Indication, IndicationInputs, IndicationPlayer};
use robot_snapshot::Writer;

use crate::config::LAYOUT;
use crate::deadlines::Watched;
use crate::drivers::analog::{AnalogInputs, AnalogReport};
use crate::drivers::buzzer::Buzzer;
use crate::drivers::status_led::StatusLed;
use crate::exchange::Exchange;
use crate::stall::SteadyTicker;
use bring_up_log::BringUpLog;
use change_log::ChangeLog;
use link_log::LinkLog;
use motor_log::MotorLog;
use radio_log::RadioLog;

mod bring_up_log;
mod change_log;
mod link_log;
mod motor_log;
mod radio_log;
mod summary;

const PERIOD: Duration = Duration::from_hz(200);
/// Periods between two checks of the diagnostics, 10 ms.
const CHANGES_DIVIDER: u32 = 2;
/// Periods between two summaries, 0.25 s.
const SUMMARY_DIVIDER: u32 = 50;

#[embassy_executor::task]
pub async fn run(
    exchange: &'static Exchange,
    mut led: StatusLed,
    mut buzzer: Buzzer,
    mut inputs: AnalogInputs,
    mut analog: Writer<'static, AnalogReport>,
) -> ! {
    let mut changes = ChangeLog::default();
    let mut bring_up = BringUpLog::default();
    let mut link = LinkLog::default();
    let mut motors = MotorLog::default();
    let mut radio = RadioLog::default();
    let mut settings = exchange.config.follower();
    let mut player = IndicationPlayer::default();
    let mut ticker = SteadyTicker::every(PERIOD);
    let mut round: u32 = 0;
    loop {
        ticker.next().await;
        Watched::Status.check_in();
        inputs.sample();
        round = round.wrapping_add(1);
        if !round.is_multiple_of(CHANGES_DIVIDER) {
            continue;
        }
        analog.publish(&inputs.report());
        let diagnostics = exchange.diagnostics.latest();
        let signal = player.step(indication(&diagnostics), Instant::now().as_micros());
        led.show(signal.led);
        buzzer.sound(signal.buzzer);
        changes.report(&diagnostics);
        bring_up.report_changes(&diagnostics);
        motors.report(&diagnostics, &settings.latest().config.joints, &LAYOUT);
        radio.report(&diagnostics);
        link.report_changes(&diagnostics);
        if round.is_multiple_of(SUMMARY_DIVIDER) {
            summary::log(&diagnostics);
            let now_us = Instant::now().as_micros();
            let age_us = now_us.saturating_sub(exchange.pc.latest().ts_us);
            link.report_numbers(&diagnostics, age_us);
            bring_up.report_joints(&diagnostics);
        }
    }
}

fn indication(diagnostics: &DiagnosticsSnapshot) -> Indication {
    Indication::select(&IndicationInputs {
        arming: &diagnostics.arming,
        safety: &diagnostics.safety,
        calibration: &diagnostics.imu_status.calibration,
        bring_up: diagnostics.bring_up.step,
        params: &diagnostics.params,
    })
}
