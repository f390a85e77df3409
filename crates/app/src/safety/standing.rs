//! The pilot's request to stand, and what ends it (docs/safety.md#standing-up).
//!
//! The stand switch requests standing when it goes from down to up. Every disarming and every stop of everything uses up
//! the request, so the switch must then go down first. While the robot stands up, a fall stops nothing: it may begin
//! lying. Afterwards a fall counts again, and any stop of a part is a stop of everything, as a robot on two wheels needs
//! all of them.

use super::SafetyFlags;
use crate::domain::{BalanceState, StandPermit, StandSwitch};

/// What decides about standing in one tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct StandingInputs {
    /// Position of the pilot's stand switch. It must come from a link that is not stopped.
    pub switch: StandSwitch,
    /// The robot was armed in the last tick.
    pub armed: bool,
    /// State of the balance controller in the last tick.
    pub balance: BalanceState,
    /// The robot lies.
    pub fallen: bool,
    /// The body is beyond the limit for balancing.
    pub topples: bool,
    /// Everything is stopped, for another reason than a fall.
    pub stopped: bool,
    /// A motor or a bus does not work.
    pub part_stopped: bool,
    /// Longest time of standing up in µs.
    pub time_us: u32,
}

/// Remembers the request.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Standing {
    permit: StandPermit,
    since_us: u64,
    stand_up_ms: u16,
    /// State of the balance controller one tick before.
    balance: BalanceState,
}

impl Standing {
    /// Forgets the request.
    pub fn restart(&mut self) {
        self.permit = StandPermit::SwitchMustGoDown;
    }

    pub const fn permit(&self) -> StandPermit {
        self.permit
    }

    /// Time in ms that standing up has taken so far.
    pub const fn stand_up_ms(&self) -> u16 {
        self.stand_up_ms
    }

    /// Whether nothing has been asked for, as most of the time on most robots.
    pub fn is_idle(&self) -> bool {
        matches!(
            self.permit,
            StandPermit::SwitchMustGoDown | StandPermit::Ready
        )
    }

    /// Advances an idle robot that sits by one tick, while the switch is not up.
    pub fn idle(&mut self, switch: StandSwitch, stopped: bool) {
        if stopped {
            self.permit = StandPermit::SwitchMustGoDown;
        } else if switch == StandSwitch::Down {
            self.permit = StandPermit::Ready;
        }
        self.balance = BalanceState::Sit;
    }

    /// Advances by one tick and returns the flags of falls.
    pub fn step(&mut self, inputs: &StandingInputs, now_us: u64) -> SafetyFlags {
        let lost = inputs.armed && self.is_lost(inputs);
        let disarmed = self.permit.permits() && !inputs.armed;
        let mut failed = inputs.armed && inputs.balance == BalanceState::CannotRise;
        self.permit = if inputs.stopped || lost || disarmed || failed {
            StandPermit::SwitchMustGoDown
        } else {
            match (self.permit, inputs.switch) {
                (_, StandSwitch::Down) => StandPermit::Ready,
                (StandPermit::Ready, StandSwitch::Unknown) => StandPermit::Ready,
                (StandPermit::Ready, StandSwitch::Up) => StandPermit::Requested,
                (StandPermit::Requested, StandSwitch::Up) => self.begin(inputs.armed, now_us),
                (StandPermit::StandingUp, StandSwitch::Up) => {
                    self.go_on(inputs, &mut failed, now_us)
                }
                (StandPermit::Standing, StandSwitch::Up) if inputs.balance != BalanceState::Sit => {
                    StandPermit::Standing
                }
                _ => StandPermit::SwitchMustGoDown,
            }
        };
        self.balance = inputs.balance;
        let mut flags = SafetyFlags::NONE;
        flags.add_if(SafetyFlags::TILT, inputs.fallen && !self.permit.may_lie());
        flags.add_if(SafetyFlags::BALANCE_LOST, lost);
        flags.add_if(SafetyFlags::STAND_UP_FAILED, failed);
        flags
    }

    fn begin(&mut self, armed: bool, now_us: u64) -> StandPermit {
        if !armed {
            return StandPermit::Requested;
        }
        self.since_us = now_us;
        self.stand_up_ms = 0;
        StandPermit::StandingUp
    }

    fn go_on(&mut self, inputs: &StandingInputs, failed: &mut bool, now_us: u64) -> StandPermit {
        let spent_us = now_us.saturating_sub(self.since_us);
        self.stand_up_ms = u16::try_from(spent_us / 1_000).unwrap_or(u16::MAX);
        let balances = matches!(inputs.balance, BalanceState::Balance | BalanceState::Jump);
        if balances && !inputs.fallen && !inputs.topples {
            StandPermit::Standing
        } else if spent_us < inputs.time_us.into() {
            StandPermit::StandingUp
        } else {
            *failed = inputs.fallen;
            StandPermit::SwitchMustGoDown
        }
    }

    /// Whether the robot can no longer stand. One that sits down must not fall either.
    fn is_lost(&self, inputs: &StandingInputs) -> bool {
        let stood = self.permit == StandPermit::Standing;
        let is_up = inputs.balance != BalanceState::Sit;
        let let_go = stood && !is_up && self.balance != BalanceState::SitDown;
        let topples = inputs.topples && is_up && self.permit != StandPermit::StandingUp;
        let crippled = inputs.part_stopped && (is_up || self.permit.permits());
        inputs.balance == BalanceState::Fallen || let_go || topples || crippled
    }
}

#[cfg(test)]
mod tests;
