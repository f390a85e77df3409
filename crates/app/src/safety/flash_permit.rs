//! When flash may be written or erased: never while a motor has torque or is about to get it (docs/parameters.md).

use super::ArmingState;
use crate::{
    domain::{JointFeedback, JointState, MotorFeedback, WheelFeedback},
    params::FlashRequest,
};

/// Motors that were let go come to rest within this time.
const REST_US: u64 = 500_000;
/// A joint motor that was silent for this long has switched itself off: its time-out is a tenth of it.
const SILENT_US: u32 = 1_000_000;
/// Rotor speed and current below which a wheel stands and nothing drives it; a C620 reports some noise.
const STILL_RPM: u16 = 60;
const STILL_MA: f32 = 500.0;

/// How long the watchdog waits now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WatchdogPeriod {
    /// As long as a hang may last.
    #[default]
    Short,
    /// On the way from one to the other: it may be either.
    Changing,
    /// Longer than any erase.
    Long,
}

/// What the tick allows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashGrant {
    /// What may begin now. Stays until the request is taken back, and arming waits for that.
    pub granted: FlashRequest,
    /// An erase outlasts the watchdog's usual period.
    pub needs_long_watchdog: bool,
    /// Something is granted or about to be.
    pub blocks_arming: bool,
}

/// All the permit looks at.
#[derive(Clone, Copy, Debug)]
pub struct FlashPermitInputs<'a> {
    pub request: FlashRequest,
    pub watchdog: WatchdogPeriod,
    /// Of the last tick.
    pub arming: ArmingState,
    /// The pilot's enable switch.
    pub enabled: bool,
    pub motor: &'a MotorFeedback,
    /// A wheel silent for longer has no say.
    pub wheel_timeout_us: u32,
}

/// One request at a time: between two of them the parameter task asks for nothing, so that arming gets its chance.
#[derive(Clone, Debug, Default)]
pub struct FlashPermit {
    grant: FlashGrant,
    armed_us: u64,
}

impl FlashPermit {
    /// Once a tick, before `Arming`.
    pub fn step(&mut self, inputs: &FlashPermitInputs<'_>, now_us: u64) -> FlashGrant {
        if inputs.arming == ArmingState::Armed {
            self.armed_us = now_us;
        }
        self.grant = if inputs.request == FlashRequest::None {
            FlashGrant {
                blocks_arming: inputs.watchdog != WatchdogPeriod::Short,
                ..FlashGrant::default()
            }
        } else if self.grant.granted == inputs.request {
            self.grant
        } else {
            self.consider(inputs, now_us)
        };
        self.grant
    }

    fn consider(&self, inputs: &FlashPermitInputs<'_>, now_us: u64) -> FlashGrant {
        let allowed = self.at_rest(inputs, now_us);
        let erases = inputs.request == FlashRequest::Erase;
        let waits = erases && inputs.watchdog != WatchdogPeriod::Long;
        FlashGrant {
            granted: if allowed && !waits {
                inputs.request
            } else {
                FlashRequest::None
            },
            needs_long_watchdog: allowed && erases,
            blocks_arming: allowed || inputs.watchdog != WatchdogPeriod::Short,
        }
    }

    fn at_rest(&self, inputs: &FlashPermitInputs<'_>, now_us: u64) -> bool {
        let disarmed = inputs.arming == ArmingState::Disarmed
            && !inputs.enabled
            && now_us.saturating_sub(self.armed_us) >= REST_US;
        let stands = |wheel: &WheelFeedback| is_still(wheel, inputs.wheel_timeout_us);
        disarmed && inputs.motor.wheels.iter().all(stands) && inputs.motor.joints.iter().all(is_off)
    }
}

fn is_still(wheel: &WheelFeedback, timeout_us: u32) -> bool {
    wheel.age_us > timeout_us
        || (wheel.rpm.unsigned_abs() <= STILL_RPM && wheel.current_ma.abs() <= STILL_MA)
}

/// Every joint has been told to disable for as long as the robot has been disarmed.
fn is_off(joint: &JointFeedback) -> bool {
    match joint.state {
        JointState::Disabled | JointState::SettingUp | JointState::Fault => true,
        JointState::Silent => joint.age_us >= SILENT_US,
        JointState::Enabling | JointState::Enabled => false,
    }
}

#[cfg(test)]
mod tests;
