//! Log lines for changes of state, at most four a second for each.

use robot_app::diagnostics::{ChangeThrottle, DiagnosticsSnapshot};
use robot_app::domain::{
    BalanceState, BusErrorState, BusId, CalibrationState, DebugProbe, HeaterState, RadioLineHealth,
    StandPermit, TemperatureGateState,
};
use robot_app::safety::{ArmingBlockers, ArmingState, SafetyFlags};

use super::motor_log::JOINT_NAMES;

/// What was logged last.
#[derive(Default)]
pub struct ChangeLog {
    arming: ChangeThrottle<ArmingState>,
    blockers: ChangeThrottle<ArmingBlockers>,
    refused: ChangeThrottle<ArmingBlockers>,
    flags: ChangeThrottle<SafetyFlags>,
    balance: ChangeThrottle<(BalanceState, StandPermit)>,
    /// Fault code of each joint.
    joint_faults: [ChangeThrottle<u32>; 4],
    buses: [ChangeThrottle<BusErrorState>; 2],
    imu_ready: ChangeThrottle<bool>,
    mag_ready: ChangeThrottle<bool>,
    calibration: ChangeThrottle<CalibrationState>,
    heater: ChangeThrottle<HeaterState>,
    line_errors: ChangeThrottle<u32>,
    debug_probe: ChangeThrottle<DebugProbe>,
    ticks_missed: ChangeThrottle<u32>,
    tuning_revision: ChangeThrottle<u32>,
}

impl ChangeLog {
    pub fn report(&mut self, d: &DiagnosticsSnapshot) {
        self.report_arming(d);
        self.report_joints(d);
        self.report_sensors(d);
        self.report_lines(d);
        self.report_debug_probe(d);
        if let Some(missed) = self.ticks_missed.due(d.tick.missed, d.ts_us) {
            defmt::warn!("control ticks missed since boot: {=u32}", missed);
        }
        if let Some(revision) = self.tuning_revision.due(d.tuning.revision, d.ts_us) {
            defmt::info!("settings changed {=u32} times since boot", revision);
        }
    }

    fn report_arming(&mut self, d: &DiagnosticsSnapshot) {
        match self.arming.due(d.arming.state, d.ts_us) {
            Some(ArmingState::Armed) => defmt::info!("armed"),
            Some(ArmingState::Disarmed) => defmt::warn!("disarmed: {}", d.arming.blockers),
            None => {}
        }
        if d.arming.state == ArmingState::Disarmed
            && let Some(blockers) = self.blockers.due(d.arming.blockers, d.ts_us)
        {
            defmt::info!("arming blocked by: {}", blockers);
        }
        // Each refusal anew: the switch was off in between.
        let refused = if d
            .arming
            .blockers
            .contains(ArmingBlockers::ENABLE_NOT_CYCLED)
        {
            d.arming.refused
        } else {
            ArmingBlockers::NONE
        };
        if let Some(refused) = self.refused.due(refused, d.ts_us)
            && !refused.is_empty()
        {
            defmt::warn!(
                "arming refused: {}; switch enable off and on again",
                refused
            );
        }
        if let Some(flags) = self.flags.due(d.safety.flags, d.ts_us) {
            defmt::warn!("safety: {} -> {}", flags, d.safety.verdict);
        }
        let balance = (d.balance.state, d.safety.stand);
        if let Some((state, stand)) = self.balance.due(balance, d.ts_us) {
            defmt::info!("balance: {}, request to stand: {}", state, stand);
        }
    }

    fn report_debug_probe(&mut self, d: &DiagnosticsSnapshot) {
        match self.debug_probe.due(d.debug_probe, d.ts_us) {
            Some(DebugProbe { catches: true, .. }) => {
                defmt::error!(
                    "a debugger halts the core at faults and does not let that be undone"
                );
            }
            Some(DebugProbe { attached: true, .. }) => defmt::warn!(
                "a debugger is attached, or was since power-on: never attach or detach it while armed"
            ),
            _ => {}
        }
    }

    /// Codes are the motor's own (docs/motors.md).
    fn report_joints(&mut self, d: &DiagnosticsSnapshot) {
        let notices = JOINT_NAMES.into_iter().zip(&mut self.joint_faults);
        for ((name, notice), joint) in notices.zip(&d.sensors.motor.joints) {
            match notice.due(joint.fault_code, d.ts_us) {
                Some(0) => defmt::info!("{=str} joint: fault cleared", name),
                Some(code) => defmt::error!("{=str} joint: motor fault {=u32:#x}", name, code),
                None => {}
            }
        }
    }

    fn report_sensors(&mut self, d: &DiagnosticsSnapshot) {
        if let Some(ready) = self.imu_ready.due(d.imu_health.ready, d.ts_us) {
            log_sensor("imu", ready, d.imu_health.errors);
        }
        if let Some(ready) = self.mag_ready.due(d.mag_health.ready, d.ts_us) {
            log_sensor("magnetometer", ready, d.mag_health.errors);
        }
        self.report_heater(d);
        self.report_calibration(d);
    }

    fn report_heater(&mut self, d: &DiagnosticsSnapshot) {
        let heater = &d.imu_status.heater;
        match self.heater.due(heater.state, d.ts_us) {
            Some(HeaterState::CutOff) => {
                defmt::warn!("imu heater cut off, {=f32} C", heater.temperature_c);
            }
            Some(state) => defmt::info!("imu heater: {}, {=f32} C", state, heater.temperature_c),
            None => {}
        }
    }

    fn report_calibration(&mut self, d: &DiagnosticsSnapshot) {
        let calibration = &d.imu_status.calibration;
        match self.calibration.due(calibration.state, d.ts_us) {
            Some(CalibrationState::Done) => {
                let [x, y, z] = d.sensors.imu.gyro_bias_dps;
                defmt::info!("gyro offset found: {=f32} {=f32} {=f32} dps", x, y, z);
                if calibration.warmth == TemperatureGateState::Unknown {
                    defmt::warn!("the imu tells no temperature: the gyro offset may drift");
                }
            }
            Some(CalibrationState::OffsetRefused) => {
                let [x, y, z] = d.sensors.imu.gyro_dps;
                defmt::warn!(
                    "gyro calibration refused: {=f32} {=f32} {=f32} dps from the stored offset, at most 2. The robot turns slowly: hold it still. If it does stand still, store the offset (imu-calibration.gyro-bias-x-dps, -y-, -z-)",
                    x,
                    y,
                    z
                );
            }
            Some(state) => defmt::info!("gyro calibration: {}", state),
            None => {}
        }
    }

    fn report_lines(&mut self, d: &DiagnosticsSnapshot) {
        for ((bus, notice), health) in BusId::ALL.into_iter().zip(&mut self.buses).zip(&d.can) {
            if let Some(state) = notice.due(health.state, d.ts_us) {
                defmt::warn!("{} is now error-{}", bus, state);
            }
        }
        let line = &d.radio_line;
        if self.line_errors.due(line.errors(), d.ts_us).is_some() {
            let RadioLineHealth {
                parity,
                framing,
                noise,
                overrun,
                ..
            } = *line;
            defmt::warn!(
                "radio line errors since boot: parity {=u32}, framing {=u32}, noise {=u32}, overrun {=u32}",
                parity,
                framing,
                noise,
                overrun
            );
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
