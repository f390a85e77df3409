//! Grants writing and erasing flash: never while a motor has torque or is about to get it (docs/parameters.md).

mod standstill;

use self::standstill::StandstillMonitor;
use super::ArmingState;
use crate::domain::{BusHealth, FlashRequest, MotorBuses, MotorFeedback};

/// Disabled motors run down within this time. Words may be programmed meanwhile: each stalls the chip for at most 0.1
/// ms, and the frames that keep motors disabled continue.
const COAST_DOWN_US: u64 = 500_000;

/// The present period of the watchdog.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WatchdogPeriod {
    /// The usual period, which limits the duration of a hang.
    #[default]
    Short,
    /// The period is being changed and may have either value.
    Changing,
    /// Longer than any erase.
    Long,
}

/// What the tick grants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashGrant {
    /// The operation that may begin now. It stays granted until the request is withdrawn, and arming waits for that.
    pub granted: FlashRequest,
    /// An erase has been requested, which outlasts the watchdog's usual period.
    pub needs_long_watchdog: bool,
    /// Something is granted or about to be.
    pub blocks_arming: bool,
}

/// Inputs of the permit.
#[derive(Clone, Copy, Debug)]
pub struct FlashPermitInputs<'a> {
    /// What the parameter task requests.
    pub request: FlashRequest,
    /// The present period of the watchdog.
    pub watchdog: WatchdogPeriod,
    /// Arming state of the last tick.
    pub arming: ArmingState,
    /// The pilot's enable switch is on.
    pub enabled: bool,
    /// Bring-up is in a step that tests motors.
    pub tests_motors: bool,
    /// Feedback of all motors.
    pub motor: &'a MotorFeedback,
    /// The bus of each motor.
    pub buses: &'a MotorBuses,
    /// State of each bus. Index = `BusId`.
    pub can: &'a [BusHealth; 2],
}

/// Grants one request at a time. The parameter task withdraws each request before the next, so arming can come in
/// between.
#[derive(Clone, Debug, Default)]
pub struct FlashPermit {
    grant: FlashGrant,
    armed_us: u64,
    /// Exists while an erase is requested and the robot is disarmed.
    rest: Option<StandstillMonitor>,
}

impl FlashPermit {
    /// Takes the place of [`step`](Self::step) in a tick without a request, which is the usual case.
    pub fn idle(&mut self, arming: ArmingState, watchdog: WatchdogPeriod, now_us: u64) {
        self.note_arming(arming, now_us);
        self.rest = None;
        self.grant = FlashGrant {
            blocks_arming: watchdog != WatchdogPeriod::Short,
            ..FlashGrant::default()
        };
    }

    /// Decides on the request; called once a tick before `Arming`.
    pub fn step(&mut self, inputs: &FlashPermitInputs<'_>, now_us: u64) {
        if inputs.request == FlashRequest::None {
            return self.idle(inputs.arming, inputs.watchdog, now_us);
        }
        self.note_arming(inputs.arming, now_us);
        if self.grant.granted != inputs.request {
            self.grant = self.decide(inputs, now_us);
        }
    }

    /// The grant of the last [`step`](Self::step) or [`idle`](Self::idle).
    pub fn grant(&self) -> FlashGrant {
        self.grant
    }

    fn note_arming(&mut self, arming: ArmingState, now_us: u64) {
        if arming == ArmingState::Armed {
            self.armed_us = now_us;
        }
    }

    fn decide(&mut self, inputs: &FlashPermitInputs<'_>, now_us: u64) -> FlashGrant {
        let allowed = self.is_allowed(inputs, now_us);
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

    fn is_allowed(&mut self, inputs: &FlashPermitInputs<'_>, now_us: u64) -> bool {
        let disarmed = inputs.arming == ArmingState::Disarmed;
        if !disarmed || inputs.enabled || inputs.tests_motors {
            self.rest = None;
            return false;
        }
        let rests = match inputs.request {
            FlashRequest::None | FlashRequest::Program => {
                self.rest = None;
                true
            }
            FlashRequest::Erase => self
                .rest
                .get_or_insert_with(|| StandstillMonitor::from(now_us))
                .is_at_standstill(inputs.motor, inputs.buses, inputs.can, now_us),
        };
        rests && now_us.saturating_sub(self.armed_us) >= COAST_DOWN_US
    }
}

#[cfg(test)]
mod tests;
