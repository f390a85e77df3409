//! The loop as the firmware runs it. It is compiled here, for speed; the crate of the firmware is compiled for size.

use super::{ControlInputs, ControlLoop, ControlOutputs};
use crate::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame},
};

pub type RobotLoop = ControlLoop<UserController, &'static mut DiagnosticsSnapshot>;

/// [`ControlLoop::on_can_frame`].
#[inline(never)]
pub fn on_can_frame(control_loop: &mut RobotLoop, bus: BusId, frame: &CanFrame, now_us: u64) {
    control_loop.on_can_frame(bus, frame, now_us);
}

/// [`ControlLoop::tick`].
#[inline(never)]
pub fn tick<'a>(
    control_loop: &'a mut RobotLoop,
    inputs: &ControlInputs<'_>,
    now_us: u64,
) -> ControlOutputs<'a> {
    control_loop.tick(inputs, now_us)
}
