//! What the arm cannot do, and what it did differently.

use super::Mismatch;
use crate::{
    bus::{BusError, ServoError},
    calibration::CalibrationError,
};

#[derive(Debug, thiserror::Error)]
pub enum ControllerError {
    #[error(transparent)]
    Bus(#[from] BusError),
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    #[error("no joint is called {name}: this arm has {known}")]
    UnknownJoint { name: String, known: String },
    #[error(
        "speed = {speed}: a speed is 0 (the most) to 32767 steps/s; 1000 is a quarter of a turn a second"
    )]
    Speed { speed: i32 },
    #[error("step_count = 0: a motion takes at least one step")]
    NoSteps,
    #[error("stopped: the arm was told to stop, and holds where it is")]
    Stopped,
    #[error("{port} did not come back within {seconds} s: {last}")]
    NotBack {
        port: String,
        seconds: u64,
        last: Box<BusError>,
    },
}

impl From<ServoError> for ControllerError {
    fn from(error: ServoError) -> Self {
        Self::Bus(error.into())
    }
}

/// Something was done, but not as asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Warning {
    #[error("{joint}: {asked} is beyond its limits of {least} to {most}: it goes to {given}")]
    Limited {
        joint: String,
        asked: i32,
        given: i32,
        least: i32,
        most: i32,
    },
    #[error("{joint}: {alarms}")]
    Alarm { joint: String, alarms: String },
    #[error(
        "{joint} answers again, but has no torque, as its power was off: hold it, and switch torque on again (Enter on a screen of \
         armctl, enable_torque in a program)"
    )]
    NoTorque { joint: String },
    #[error("{0}")]
    Mismatch(Mismatch),
}
