//! The black box task, 100 Hz: records the report of the control task, and keeps it around every stop that nobody asked for.
//! No task waits for it, so it has no deadline.

use robot_app::black_box::BlackBox;
use robot_app::domain::{BankState, BlackBoxStatus, EventKind};
use robot_snapshot::Writer;

use crate::black_box_memory;
use crate::crash_record::LastRun;
use crate::exchange::{Exchange, REPORT_PULSE};

#[embassy_executor::task]
pub async fn run(
    last_run: LastRun,
    exchange: &'static Exchange,
    mut output: Writer<'static, BlackBoxStatus>,
) -> ! {
    let LastRun {
        reset_cause,
        crash_cause,
    } = last_run;
    let mut black_box = BlackBox::boot(black_box_memory::memory(), reset_cause, crash_cause);
    let mut shown = BlackBoxStatus::default();
    loop {
        let status = *black_box.status();
        if status != shown {
            report_changes(&shown, &status);
            shown = status;
            output.publish(&status);
        }
        REPORT_PULSE.wait().await;
        let wheels = exchange.config.latest().config.wheel_odom;
        black_box.step(&exchange.diagnostics.latest(), &wheels);
    }
}

fn report_changes(before: &BlackBoxStatus, now: &BlackBoxStatus) {
    if now.overwritten != before.overwritten {
        defmt::warn!("black box: an event that nobody has read is overwritten by the new drive");
    }
    for (old, new) in before.banks.iter().zip(&now.banks) {
        if new.state == BankState::Event && old.state != BankState::Event {
            let what = match new.kind {
                EventKind::Reset => "a reset",
                EventKind::PartialStop => "a partial stop",
                EventKind::Stop | EventKind::None => "a stop",
            };
            defmt::warn!(
                "black box: event {=u16}, {=str}; `robotctl blackbox` shows it",
                new.number,
                what
            );
        }
    }
}
