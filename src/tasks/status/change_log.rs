//! One log line for each change of state.

use robot_app::diagnostics::DiagnosticsSnapshot;
use robot_app::domain::{BusErrorState, BusId};
use robot_app::safety::{ArmingBlockers, ArmingState, SafetyFlags};

use crate::drivers::radio_uart::LineErrors;
use crate::exchange::RADIO_LINE;

/// What was logged last.
#[derive(Default)]
pub struct ChangeLog {
    armed: ArmingState,
    blockers: ArmingBlockers,
    flags: SafetyFlags,
    buses: [BusErrorState; 2],
    imu_ready: bool,
    mag_ready: bool,
    calibrated: bool,
    line_errors: LineErrors,
    ticks_missed: u32,
}

impl ChangeLog {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn report(&mut self, d: &DiagnosticsSnapshot) {
        self.report_arming(d);
        self.report_sensors(d);
        for (bus, (last, now)) in BusId::ALL
            .into_iter()
            .zip(self.buses.iter_mut().zip(d.can.iter().map(|bus| bus.state)))
        {
            if changed(last, now) {
                defmt::warn!("{} is now error-{}", bus, now);
            }
        }
        if changed(&mut self.line_errors, RADIO_LINE.errors()) {
            let LineErrors {
                parity,
                framing,
                noise,
                overrun,
            } = self.line_errors;
            defmt::warn!(
                "radio line errors since boot: parity {=u32}, framing {=u32}, noise {=u32}, overrun {=u32}",
                parity,
                framing,
                noise,
                overrun
            );
        }
        if changed(&mut self.ticks_missed, d.tick.missed) {
            defmt::warn!("control ticks missed since boot: {=u32}", self.ticks_missed);
        }
    }

    fn report_arming(&mut self, d: &DiagnosticsSnapshot) {
        if changed(&mut self.armed, d.arming.state) {
            match self.armed {
                ArmingState::Armed => defmt::info!("armed"),
                ArmingState::Disarmed => defmt::warn!("disarmed: {}", d.arming.blockers),
            }
        }
        if changed(&mut self.blockers, d.arming.blockers) && self.armed == ArmingState::Disarmed {
            defmt::info!("arming blocked by: {}", self.blockers);
        }
        if changed(&mut self.flags, d.safety.flags) {
            defmt::warn!("safety: {} -> {}", self.flags, d.safety.verdict);
        }
    }

    fn report_sensors(&mut self, d: &DiagnosticsSnapshot) {
        if changed(&mut self.imu_ready, d.imu_health.ready) {
            log_sensor("imu", self.imu_ready, d.imu_health.errors);
        }
        if changed(&mut self.mag_ready, d.mag_health.ready) {
            log_sensor("magnetometer", self.mag_ready, d.mag_health.errors);
        }
        if changed(&mut self.calibrated, d.imu_calibrated) {
            let [x, y, z] = d.imu.gyro_bias_dps;
            defmt::info!("gyro offset found: {=f32} {=f32} {=f32} dps", x, y, z);
        }
    }
}

fn log_sensor(name: &str, ready: bool, errors: u32) {
    if ready {
        defmt::info!("{=str} ready, {=u32} errors since boot", name, errors);
    } else {
        defmt::warn!("{=str} lost, {=u32} errors since boot", name, errors);
    }
}

/// Stores `now` and says whether it differs.
fn changed<T: PartialEq>(last: &mut T, now: T) -> bool {
    if *last == now {
        return false;
    }
    *last = now;
    true
}
