//! The trait by which the manager knows a motor of any make.

use crate::domain::CanFrame;

/// One motor on a CAN bus.
pub trait Motor {
    /// The setpoint from the controller. It may hold any value, even NaN.
    type Command;
    /// Settings of this motor's place in the robot.
    type Config;
    /// The last report, in the units and coordinates of the controller.
    type Feedback;
    /// What is sent in one tick.
    type Output;

    /// Takes a frame from the motor's bus. Returns false, without any effect, if it is not from this motor.
    fn receive(&mut self, frame: &CanFrame, ts_us: u64) -> bool;

    /// Updates the age of the last report; called once a tick. After a silence of more than `timeout_us` the motor
    /// may have lost its settings.
    fn update_age(&mut self, timeout_us: u32, now_us: u64);

    /// Copies the last report to `feedback`, with the age that [`update_age`](Self::update_age) found. Changed
    /// settings apply from the next report on.
    fn feedback(&self, config: &Self::Config, feedback: &mut Self::Feedback);

    /// Returns what to send in this tick; called once a tick, after the rest. The torque is exactly zero unless
    /// `permitted`.
    fn drive(
        &mut self,
        command: &Self::Command,
        config: &Self::Config,
        permitted: bool,
        now_us: u64,
    ) -> Self::Output;
}
