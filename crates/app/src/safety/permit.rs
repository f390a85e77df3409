//! The proof that torque may leave the board in this tick.

use super::{ArmedToken, SafetyStatus};
use crate::domain::BusId;

/// Permits torque in one tick. It takes the token that only `Arming` hands out.
#[derive(Debug)]
pub struct TorquePermit {
    status: SafetyStatus,
}

impl TorquePermit {
    /// A permit limited by the stops of `status`.
    pub fn new(_armed: ArmedToken, status: &SafetyStatus) -> Self {
        Self { status: *status }
    }

    /// Whether the limits of standing up apply: the robot may lie.
    pub const fn is_for_standing_up(&self) -> bool {
        self.status.stand.may_lie()
    }

    /// Whether wheels on this bus may get current.
    pub const fn allows_wheels(&self, bus: BusId) -> bool {
        !self.status.stops_wheels(bus)
    }

    /// Whether joints on this bus may be enabled.
    pub const fn allows_joints(&self, bus: BusId) -> bool {
        !self.status.stops_joints(bus)
    }
}
