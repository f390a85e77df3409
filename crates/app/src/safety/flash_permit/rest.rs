//! Whether everything that can move is off and still: during an erase no motor is watched and none is told anything.

use crate::domain::{
    BusErrorState, BusHealth, BusId, JointFeedback, JointState, MotorBuses, MotorFeedback,
    WheelFeedback,
};

/// Rest must last without a break: a wheel that swings back passes zero.
const REST_US: u32 = 500_000;
/// A motor that was silent for this long has no supply or no wire, or has given up: no report says that it is off.
const GONE_US: u32 = 1_000_000;
/// For this long its bus must have carried what tells it to be off.
const TOLD_US: u32 = 1_000_000;
/// Rotor speed and current below which a wheel stands and nothing drives it; a C620 reports some noise.
const STILL_RPM: u16 = 60;
const STILL_MA: f32 = 500.0;

/// For as long as the robot is disarmed: then nothing but zero currents and disable frames goes out. Keeps the low half
/// of times: a turn of 71 minutes can only make it wait once more.
#[derive(Clone, Debug)]
pub struct RestWatch {
    /// When something last spoke against it.
    unrest_us: u32,
    /// Index = `BusId`: when a frame last did not leave.
    failed_us: [u32; 2],
}

impl RestWatch {
    /// What came before does not count.
    pub fn from(now_us: u64) -> Self {
        let now_us = now_us as u32;
        Self {
            unrest_us: now_us,
            failed_us: [now_us; 2],
        }
    }

    /// Once a tick. True when there has been rest for long enough.
    pub fn lasts(
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
        let told = |bus: BusId| {
            let [can1_us, can2_us] = self.failed_us;
            let failed_us = match bus {
                BusId::Can1 => can1_us,
                BusId::Can2 => can2_us,
            };
            now_us.wrapping_sub(failed_us) >= TOLD_US
        };
        let mut wheels = motor.wheels.iter();
        let mut joints = motor.joints.iter().zip(buses.joints);
        let rests = wheels.all(|wheel| stands(wheel, told(buses.wheels)))
            && joints.all(|(joint, bus)| is_off(joint, told(bus)));
        if !rests {
            self.unrest_us = now_us;
        }
        now_us.wrapping_sub(self.unrest_us) >= REST_US
    }
}

/// A motor's voice.
enum Voice {
    NeverHeard,
    Reports,
    Gone,
}

impl Voice {
    fn of(ts_us: u64, age_us: u32) -> Self {
        if ts_us == 0 {
            Self::NeverHeard
        } else if age_us < GONE_US {
            Self::Reports
        } else {
            Self::Gone
        }
    }
}

fn stands(wheel: &WheelFeedback, told: bool) -> bool {
    match Voice::of(wheel.ts_us, wheel.age_us) {
        Voice::NeverHeard => true,
        Voice::Reports => {
            wheel.rpm.unsigned_abs() <= STILL_RPM && wheel.current_ma.abs() <= STILL_MA
        }
        Voice::Gone => told,
    }
}

fn is_off(joint: &JointFeedback, told: bool) -> bool {
    match Voice::of(joint.ts_us, joint.age_us) {
        Voice::NeverHeard => true,
        Voice::Reports => match joint.state {
            JointState::Disabled | JointState::SettingUp | JointState::Fault => {
                !joint.reports_enabled
            }
            JointState::Silent | JointState::Enabling | JointState::Enabled => false,
        },
        Voice::Gone => told,
    }
}

#[cfg(test)]
mod tests;
