//! The proof that a current may leave the board in this tick.

use super::{ArmedToken, SafetyStatus};
use crate::domain::BusId;

/// Needs the token that only `Arming` hands out; made anew each tick.
#[derive(Debug)]
pub struct TorquePermit {
    status: SafetyStatus,
}

impl TorquePermit {
    pub fn new(_armed: ArmedToken, status: &SafetyStatus) -> Self {
        Self { status: *status }
    }

    pub fn allows(&self, bus: BusId) -> bool {
        !self.status.stops(bus)
    }
}
