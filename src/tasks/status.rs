//! LED, battery voltage and the log. Checks for changes of state at 100 Hz, sums up at 4 Hz.

use embassy_time::{Duration, Instant, Ticker};
use robot_app::diagnostics::DiagnosticsSnapshot;
use robot_app::safety::{ArmingState, SafetyVerdict};
use robot_snapshot::Writer;

use crate::deadlines::Watched;
use crate::drivers::battery::Battery;
use crate::drivers::status_led::{Colour, StatusLed};
use crate::exchange::Exchange;
use change_log::ChangeLog;

mod change_log;
mod summary;

const PERIOD: Duration = Duration::from_hz(100);
/// Periods between two summaries, 0.25 s.
const SUMMARY_DIVIDER: u32 = 25;

#[embassy_executor::task]
pub async fn run(
    exchange: &'static Exchange,
    mut led: StatusLed,
    mut battery: Battery,
    mut battery_v: Writer<'static, f32>,
) -> ! {
    let mut changes = ChangeLog::default();
    let mut ticker = Ticker::every(PERIOD);
    let mut round: u32 = 0;
    loop {
        ticker.next().await;
        Watched::Status.check_in();
        let diagnostics = exchange.diagnostics.latest();
        led.show(colour(&diagnostics));
        changes.report(&diagnostics);
        round = round.wrapping_add(1);
        if round.is_multiple_of(SUMMARY_DIVIDER) {
            battery_v.publish(&battery.read_v());
            summary::log(&diagnostics);
        }
    }
}

/// Green: armed. Red: a stop. Blue blinking at 1 Hz: ready to be armed.
fn colour(diagnostics: &DiagnosticsSnapshot) -> Colour {
    if diagnostics.arming.state == ArmingState::Armed {
        return Colour::Green;
    }
    if diagnostics.safety.verdict != SafetyVerdict::Run {
        return Colour::Red;
    }
    let second_half = Instant::now().as_millis() % 1_000 >= 500;
    if second_half {
        Colour::Blue
    } else {
        Colour::Off
    }
}
