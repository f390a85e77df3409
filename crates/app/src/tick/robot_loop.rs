//! The loop as the firmware runs it. It is compiled here, for speed; the crate of the firmware is compiled for size.

use super::{ControlInputs, ControlLoop, ControlOutputs};
use crate::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame, RobotConfig},
    motor::layout::MotorLayout,
};

/// The loop with the place where its report goes, which a debugger knows.
#[derive(Debug)]
pub struct RobotLoop {
    control_loop: ControlLoop,
    diagnostics: &'static mut DiagnosticsSnapshot,
}

impl RobotLoop {
    pub fn new(
        layout: &'static MotorLayout,
        config: RobotConfig,
        diagnostics: &'static mut DiagnosticsSnapshot,
    ) -> Self {
        Self {
            control_loop: ControlLoop::with_layout(layout, config, UserController::default()),
            diagnostics,
        }
    }

    /// [`ControlLoop::on_can_frame`].
    #[inline(never)]
    pub fn on_can_frame(&mut self, bus: BusId, frame: &CanFrame, now_us: u64) {
        self.control_loop
            .on_can_frame(bus, frame, now_us, self.diagnostics);
    }

    /// [`ControlLoop::after_stall`].
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        self.control_loop.after_stall(stall_us, now_us);
    }

    /// [`ControlLoop::tick`].
    #[inline(never)]
    pub fn tick(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> ControlOutputs<'_> {
        self.control_loop.tick(inputs, now_us, self.diagnostics)
    }
}
