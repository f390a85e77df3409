//! When flash may be written or erased: never while a motor has torque or is about to get it (docs/parameters.md).

mod rest;

use self::rest::RestWatch;
use super::ArmingState;
use crate::domain::{BusHealth, FlashRequest, MotorBuses, MotorFeedback};

/// Motors that were let go slow down within this time. Words may be programmed then: each stops the chip for 0.1 ms at
/// most, and the frames that keep motors off go on.
const LET_GO_US: u64 = 500_000;

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
    /// Bring-up is in a step in which motors are tried out.
    pub tries_motors: bool,
    pub motor: &'a MotorFeedback,
    pub buses: &'a MotorBuses,
    /// Index = `BusId`.
    pub can: &'a [BusHealth; 2],
}

/// One request at a time: between two of them the parameter task asks for nothing, so that arming gets its chance.
#[derive(Clone, Debug, Default)]
pub struct FlashPermit {
    grant: FlashGrant,
    armed_us: u64,
    /// While an erase is asked for and the robot is disarmed.
    rest: Option<RestWatch>,
}

impl FlashPermit {
    /// In place of [`step`](Self::step) in a tick in which nothing is asked for, which nearly every one is.
    pub fn idle(&mut self, arming: ArmingState, watchdog: WatchdogPeriod, now_us: u64) {
        self.note_arming(arming, now_us);
        self.rest = None;
        self.grant = FlashGrant {
            blocks_arming: watchdog != WatchdogPeriod::Short,
            ..FlashGrant::default()
        };
    }

    /// Once a tick, before `Arming`.
    pub fn step(&mut self, inputs: &FlashPermitInputs<'_>, now_us: u64) {
        if inputs.request == FlashRequest::None {
            return self.idle(inputs.arming, inputs.watchdog, now_us);
        }
        self.note_arming(inputs.arming, now_us);
        if self.grant.granted != inputs.request {
            self.grant = self.consider(inputs, now_us);
        }
    }

    /// As of the last of both.
    pub fn grant(&self) -> FlashGrant {
        self.grant
    }

    fn note_arming(&mut self, arming: ArmingState, now_us: u64) {
        if arming == ArmingState::Armed {
            self.armed_us = now_us;
        }
    }

    fn consider(&mut self, inputs: &FlashPermitInputs<'_>, now_us: u64) -> FlashGrant {
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
        if !disarmed || inputs.enabled || inputs.tries_motors {
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
                .get_or_insert_with(|| RestWatch::from(now_us))
                .lasts(inputs.motor, inputs.buses, inputs.can, now_us),
        };
        rests && now_us.saturating_sub(self.armed_us) >= LET_GO_US
    }
}

#[cfg(test)]
mod tests;
