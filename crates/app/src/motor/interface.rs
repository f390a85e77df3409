//! What every motor is to the manager, whatever its make.

use crate::domain::CanFrame;

/// One motor on a CAN bus.
pub trait Motor {
    /// What control asks for; it may be anything, even NaN.
    type Command;
    /// What fits the motor to its place in the robot.
    type Config;
    /// Last report, in the units and coordinates of control.
    type Feedback;
    /// What leaves in one tick.
    type Output;

    /// Takes a frame from the motor's bus; false, and no trace, if it is not from this motor.
    fn receive(&mut self, frame: &CanFrame, ts_us: u64) -> bool;

    /// Once a tick: ages its reports. Silence beyond `timeout_us` means that the motor may have lost its settings.
    fn watch(&mut self, timeout_us: u32, now_us: u64);

    /// Brings `feedback` up to the last report, as old as [`watch`](Self::watch) found it. Settings that have changed
    /// count from the next report on.
    fn feedback(&self, config: &Self::Config, feedback: &mut Self::Feedback);

    /// Once a tick, last. Exactly zero torque unless `permitted`.
    fn drive(
        &mut self,
        command: &Self::Command,
        config: &Self::Config,
        permitted: bool,
        now_us: u64,
    ) -> Self::Output;
}
