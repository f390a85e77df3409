//! Writes the report about a tick. No other code writes it.

use super::{ControlInputs, ControlLoop};
use crate::{
    control::ChassisController,
    diagnostics::{DiagnosticsSnapshot, TickStats},
    domain::{SensorsSnapshot, StateEstimate, age_us},
    tick::TickState,
};

impl<C: ChassisController> ControlLoop<C> {
    pub(super) fn record(
        &self,
        inputs: &ControlInputs<'_>,
        now_us: u64,
        diagnostics: &mut DiagnosticsSnapshot,
    ) {
        let health = inputs.health;
        diagnostics.ts_us = now_us;
        if diagnostics.remote.ts_us != inputs.remote.state.ts_us {
            diagnostics.remote = inputs.remote.state;
        }
        if diagnostics.logic.ts_us != inputs.logic.ts_us {
            diagnostics.logic = *inputs.logic;
        }
        diagnostics.late_tasks = health.late_tasks;
        diagnostics.tick = TickStats {
            max_jitter_cycles: diagnostics.tick.max_jitter_cycles,
            ..self.state.stats
        };
        self.state.record(diagnostics);
        self.motors.record_sent(&mut diagnostics.command);
        diagnostics.tuning = *self.tuning.status();
        if self.phase == 0 {
            self.state.record_slow(diagnostics);
            diagnostics.bring_up = *self.bring_up.status();
            diagnostics.drive_end = *self.arming.drive_end();
            record_slow(inputs, now_us, diagnostics);
        }
    }
}

/// Records what changes slowly or only matters to an observer.
fn record_slow(inputs: &ControlInputs<'_>, now_us: u64, diagnostics: &mut DiagnosticsSnapshot) {
    let health = inputs.health;
    diagnostics.remote_raw = inputs.remote.raw;
    diagnostics.can = health.can;
    diagnostics.imu_health = health.imu;
    diagnostics.mag_health = health.mag;
    diagnostics.radio_line = health.radio_line;
    diagnostics.imu_calibrated = health.imu_calibrated;
    diagnostics.imu_status = health.imu_status;
    diagnostics.reset_cause = health.reset_cause;
    diagnostics.tick.max_jitter_cycles = health.max_jitter_cycles;
    diagnostics.last_words = health.last_words;
    diagnostics.battery_v = health.battery_v;
    diagnostics.black_box = health.black_box;
    diagnostics.debug_probe = health.debug_probe;
    diagnostics.link = health.link;
    // The link's state is older than the tick by up to two reports.
    diagnostics.pc_age_us = age_us(inputs.pc.ts_us, now_us);
    diagnostics.params = *inputs.params;
}

impl TickState {
    /// Records what changes slowly or only matters to an observer.
    fn record_slow(&self, diagnostics: &mut DiagnosticsSnapshot) {
        diagnostics.operator = self.operator;
        diagnostics.remote_diag = self.link;
        diagnostics.motors = self.motors;
        diagnostics.strangers = self.strangers;
        diagnostics.estimate.gyro_bias_rps = self.estimate.gyro_bias_rps;
        diagnostics.estimate.accel_bias_mps2 = self.estimate.accel_bias_mps2;
    }

    fn record(&self, diagnostics: &mut DiagnosticsSnapshot) {
        record_sensors(&self.sensors, &mut diagnostics.sensors);
        record_estimate(&self.estimate, &mut diagnostics.estimate);
        diagnostics.safety = self.safety;
        diagnostics.arming = self.arming;
        if !(self.balance.sits() && diagnostics.balance.sits()) {
            diagnostics.balance = self.balance;
        }
    }
}

/// Copies field by field. Copying the whole struct would cost a loop over its words in each tick.
fn record_sensors(found: &SensorsSnapshot, sensors: &mut SensorsSnapshot) {
    if sensors.imu.ts_us != found.imu.ts_us {
        sensors.imu = found.imu;
    }
    if sensors.mag.ts_us != found.mag.ts_us {
        sensors.mag = found.mag;
    }
    sensors.motor.wheels = found.motor.wheels;
    let [left_front, left_rear, right_front, right_rear] = &mut sensors.motor.joints;
    [*left_front, *left_rear, *right_front, *right_rear] = found.motor.joints;
    sensors.motor.ts_us = found.motor.ts_us;
    sensors.ts_us = found.ts_us;
}

/// Copies field by field, as [`record_sensors`] does.
fn record_estimate(found: &StateEstimate, estimate: &mut StateEstimate) {
    estimate.q_wxyz = found.q_wxyz;
    estimate.rpy_rad = found.rpy_rad;
    estimate.vel_mps = found.vel_mps;
    estimate.pos_m = found.pos_m;
    estimate.ts_us = found.ts_us;
    estimate.valid = found.valid;
}
