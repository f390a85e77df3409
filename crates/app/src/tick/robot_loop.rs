//! The loop as the firmware runs it. It is compiled in this crate for speed, as the firmware's crate is compiled for
//! size.

use super::{ControlInputs, ControlLoop, ControlOutputs};
use crate::{
    black_box::BlackBoxMemory,
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame, RobotConfig},
    motor::layout::MotorLayout,
};

/// The control loop together with its report, whose address a debugger knows.
#[derive(Debug)]
pub struct RobotLoop {
    control_loop: ControlLoop,
    diagnostics: &'static mut DiagnosticsSnapshot,
}

impl RobotLoop {
    /// A loop for the robot with this motor layout, writing its report into `diagnostics`.
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

    /// See [`ControlLoop::set_black_box`].
    pub fn set_black_box(&mut self, memory: &'static BlackBoxMemory) {
        self.control_loop.set_black_box(memory);
    }

    /// See [`ControlLoop::on_can_frame`].
    #[inline(never)]
    pub fn on_can_frame(&mut self, bus: BusId, frame: &CanFrame, now_us: u64) {
        self.control_loop
            .on_can_frame(bus, frame, now_us, self.diagnostics);
    }

    /// See [`ControlLoop::on_link_frame`].
    pub fn on_link_frame(&mut self, frame: &CanFrame, now_us: u64) {
        self.control_loop
            .on_link_frame(frame, now_us, self.diagnostics);
    }

    /// See [`ControlLoop::after_stall`].
    pub fn after_stall(&mut self, stall_us: u32, now_us: u64) {
        self.control_loop.after_stall(stall_us, now_us);
    }

    /// See [`ControlLoop::tick`].
    #[inline(never)]
    pub fn tick(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> ControlOutputs<'_> {
        self.control_loop.tick(inputs, now_us, self.diagnostics)
    }
}
