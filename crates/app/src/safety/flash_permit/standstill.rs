//! Checks that everything that can move is off and at rest. During an erase the motors are neither observed nor
//! commanded.

use crate::domain::{
    BusErrorState, BusHealth, BusId, JointFeedback, JointState, MotorBuses, MotorFeedback,
    WheelFeedback,
};

/// The robot must be at rest for this long without a break: a wheel that swings back passes zero speed.
const REST_US: u32 = 500_000;
/// A motor that has been silent for this long has no supply, no wire, or a defect. No report can show that it is off.
const LOST_US: u32 = 1_000_000;
/// The bus of a lost motor must have carried its disable frames for this long.
const COMMANDED_OFF_US: u32 = 1_000_000;
/// Limits of rotor speed and current for a wheel at rest. A C620 reports some noise.
const STILL_RPM: u16 = 60;
const STILL_MA: f32 = 500.0;

/// Exists while the robot is disarmed, when only zero currents and disable frames are sent. It keeps the low half of
/// times, which wrap after 71 minutes; a wrap can only make it wait once more.
#[derive(Clone, Debug)]
pub struct StandstillMonitor {
    /// The last time that something was not at rest.
    last_motion_us: u32,
    /// The last time that a frame could not be sent. Index = `BusId`.
    failed_us: [u32; 2],
}

impl StandstillMonitor {
    /// Starts at `now_us`. Earlier rest does not count.
    pub fn from(now_us: u64) -> Self {
        let now_us = now_us as u32;
        Self {
            last_motion_us: now_us,
            failed_us: [now_us; 2],
        }
    }

    /// Returns whether the robot has been at rest for long enough; called once a tick.
    pub fn is_at_standstill(
        &mut self,
        motor: &MotorFeedback,
        buses: &MotorBuses,
        can: &[BusHealth; 2],
        now_us: u64,
    ) -> bool {
        let now_us = now_us as u32;
        for (failed_us, bus) in self.failed_us.iter_mut().zip(can) {
            if bus.state != BusErrorState::Active || bus.tx_failures_in_row != 0 {
                *failed_us = now_us;
            }
        }
        let commanded_off = |bus: BusId| {
            let [can1_us, can2_us] = self.failed_us;
            let failed_us = match bus {
                BusId::Can1 => can1_us,
                BusId::Can2 => can2_us,
            };
            now_us.wrapping_sub(failed_us) >= COMMANDED_OFF_US
        };
        let mut wheels = motor.wheels.iter();
        let mut joints = motor.joints.iter().zip(buses.joints);
        let rests = wheels.all(|wheel| is_at_rest(wheel, commanded_off(buses.wheels)))
            && joints.all(|(joint, bus)| is_off(joint, commanded_off(bus)));
        if !rests {
            self.last_motion_us = now_us;
        }
        now_us.wrapping_sub(self.last_motion_us) >= REST_US
    }
}

/// What is known from a motor's reports.
enum ReportState {
    NeverHeard,
    Reports,
    Gone,
}

impl ReportState {
    fn of(ts_us: u64, age_us: u32) -> Self {
        if ts_us == 0 {
            Self::NeverHeard
        } else if age_us < LOST_US {
            Self::Reports
        } else {
            Self::Gone
        }
    }
}

fn is_at_rest(wheel: &WheelFeedback, commanded_off: bool) -> bool {
    match ReportState::of(wheel.ts_us, wheel.age_us) {
        ReportState::NeverHeard => true,
        ReportState::Reports => {
            wheel.rpm.unsigned_abs() <= STILL_RPM && wheel.current_ma.abs() <= STILL_MA
        }
        ReportState::Gone => commanded_off,
    }
}

fn is_off(joint: &JointFeedback, commanded_off: bool) -> bool {
    match ReportState::of(joint.ts_us, joint.age_us) {
        ReportState::NeverHeard => true,
        ReportState::Reports => match joint.state {
            JointState::Disabled | JointState::SettingUp | JointState::Fault => {
                !joint.reports_enabled
            }
            JointState::Silent | JointState::Enabling | JointState::Enabled => false,
        },
        ReportState::Gone => commanded_off,
    }
}

#[cfg(test)]
mod tests;
