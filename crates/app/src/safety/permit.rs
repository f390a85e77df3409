//! The proof that torque may leave the board in this tick.

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

    /// True if wheels on this bus may push.
    pub const fn allows_wheels(&self, bus: BusId) -> bool {
        !self.status.stops_wheels(bus)
    }

    /// True if joints on this bus may be enabled.
    pub const fn allows_joints(&self, bus: BusId) -> bool {
        !self.status.stops_joints(bus)
    }
}
