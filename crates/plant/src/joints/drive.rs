//! What every joint motor has in common.

use super::{actuator::Actuator, reply::ReplyBox};
use crate::{time::Ps, wire::CanFrame};

/// Angle and speed of an output shaft, in the motor's own sense of rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Shaft {
    pub pos_rad: f64,
    pub vel_rps: f64,
}

/// The faults of one motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DriveFaults {
    /// No supply: no torque, no reply, no acknowledge; settings not stored are lost.
    pub gone: bool,
    /// Replies repeat the last one; the motor still obeys.
    pub frozen: bool,
    /// The winding is at 120 °C.
    pub hot: bool,
    /// Somebody gave the motor another identifier.
    pub wrong_id: bool,
    /// The driver finds a fault and lets go.
    pub tripped: bool,
    /// A register write takes as long as storing does (DM4310).
    pub slow_writes: bool,
}

/// What a motor did with a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Reception {
    /// The frame is not addressed to this motor.
    Ignored,
    /// The motor took the frame.
    Accepted,
    /// The frame is addressed to this motor, but the model lacks what it asks for.
    NotModelled(String),
}

/// A geared motor with its driver on the CAN bus.
pub(super) trait Drive: Send {
    fn set_faults(&mut self, faults: DriveFaults, now: Ps);

    /// False while the motor has no supply.
    fn powered(&self) -> bool;

    fn receive(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception;

    /// Advances the driver and the motor by `dt_s`.
    fn step(&mut self, shaft: Shaft, supply_v: f64, now: Ps, dt_s: f64);

    fn enabled(&self) -> bool;

    /// Torque that the present command asks for, before the limits of motor and supply.
    fn commanded_nm(&self, shaft: Shaft) -> f64;

    /// Disable frames received since power-on.
    fn stop_frames(&self) -> u64;

    fn replies(&self) -> &ReplyBox;

    fn replies_mut(&mut self) -> &mut ReplyBox;

    fn actuator(&self) -> &Actuator;
}
