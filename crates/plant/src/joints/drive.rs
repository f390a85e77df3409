//! Common parts of all joint motors.

use super::{
    actuator::{Actuator, Rating},
    reply::ReplyBox,
    speed_loop::SpeedLoop,
};
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
    /// The motor has been given another identifier.
    pub wrong_id: bool,
    /// The driver detects a fault and switches off.
    pub tripped: bool,
    /// A register write takes as long as storing does (DM4310).
    pub slow_writes: bool,
}

/// Reaction of a motor to a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Reception {
    /// The frame is not addressed to this motor.
    Ignored,
    /// The motor took the frame.
    Accepted,
    /// The frame is addressed to this motor, but requests something that is not modelled.
    NotModelled(String),
}

/// The parts that every drive has.
#[derive(Clone)]
pub(super) struct DriveParts {
    pub actuator: Actuator,
    pub speed_loop: SpeedLoop,
    pub replies: ReplyBox,
    /// Shaft angle that reads as 0, rad.
    pub zero_rad: f64,
    pub faults: DriveFaults,
    pub last_frame_at: Ps,
    pub stop_frames: u64,
}

impl DriveParts {
    pub fn new(rating: &'static Rating) -> Self {
        Self {
            actuator: Actuator::new(rating),
            speed_loop: SpeedLoop::default(),
            replies: ReplyBox::default(),
            zero_rad: 0.0,
            faults: DriveFaults::default(),
            last_frame_at: 0,
            stop_frames: 0,
        }
    }

    /// Cuts the torque and resets the speed loop.
    pub fn cut(&mut self) {
        self.speed_loop = SpeedLoop::default();
        self.actuator.cut();
    }
}

/// A geared motor with its driver on the CAN bus.
pub(super) trait Drive: Send + Sync {
    /// The same drive once more.
    fn boxed(&self) -> Box<dyn Drive>;

    fn parts(&self) -> &DriveParts;

    fn parts_mut(&mut self) -> &mut DriveParts;

    fn set_faults(&mut self, faults: DriveFaults, now: Ps);

    fn receive(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception;

    /// Advances the driver and the motor by `dt_s`.
    fn step(&mut self, shaft: Shaft, supply_v: f64, now: Ps, dt_s: f64);

    fn enabled(&self) -> bool;

    /// Torque that the current command demands, before the limits of motor and supply.
    fn commanded_nm(&self, shaft: Shaft) -> f64;

    /// False while the motor has no supply.
    fn powered(&self) -> bool {
        !self.parts().faults.gone
    }

    /// Disable frames received since power-on.
    fn stop_frames(&self) -> u64 {
        self.parts().stop_frames
    }

    fn actuator(&self) -> &Actuator {
        &self.parts().actuator
    }

    fn replies(&self) -> &ReplyBox {
        &self.parts().replies
    }

    fn replies_mut(&mut self) -> &mut ReplyBox {
        &mut self.parts_mut().replies
    }
}

impl Clone for Box<dyn Drive> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}
