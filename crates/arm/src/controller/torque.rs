//! Torque on and off.

use super::{ControllerError, Joint, ServoController};
use crate::bus::{
    BusError,
    register::{PRESENT_POSITION, TORQUE_ENABLE},
};

/// Whether a joint's driver is on, as far as is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Torque {
    #[default]
    Off,
    On,
    /// It was on until the servo had no power. A motion does not switch it on again, as somebody may have a hand at its plug.
    Lost,
}

impl ServoController {
    /// Switches torque on without a jump: the goal of each joint that had none becomes the place where it is.
    pub fn enable_torque(&mut self) -> Result<(), ControllerError> {
        self.switch_on(|torque| torque != Torque::On)
    }

    /// Switches torque on before a motion, but for joints that have lost it.
    pub(super) fn begin_motion(&mut self) -> Result<(), ControllerError> {
        self.switch_on(|torque| torque == Torque::Off)
    }

    fn switch_on(&mut self, is_meant: impl Fn(Torque) -> bool) -> Result<(), ControllerError> {
        let is_meant = |joint: &Joint| is_meant(joint.torque);
        self.hold_if(is_meant)?;
        for joint in &mut self.joints {
            if is_meant(joint) {
                self.bus.write(joint.calibration.id, TORQUE_ENABLE, 1)?;
                joint.torque = Torque::On;
            }
        }
        Ok(())
    }

    /// Makes each joint's goal the place where it is: the arm stops and stays. A joint that does not answer keeps its goal, and is
    /// an error after all others have stopped.
    pub fn hold(&mut self) -> Result<(), ControllerError> {
        self.hold_if(|_| true)
    }

    fn hold_if(&mut self, is_meant: impl Fn(&Joint) -> bool) -> Result<(), ControllerError> {
        let joints: Vec<&Joint> = self.joints.iter().filter(|joint| is_meant(joint)).collect();
        if joints.is_empty() {
            return Ok(());
        }
        let ids: Vec<u8> = joints.iter().map(|joint| joint.calibration.id).collect();
        let readings = self.bus.sync_read(&ids, PRESENT_POSITION.into())?;
        let mut goals = Vec::new();
        let mut failed = None;
        for ((id, joint), reading) in ids.iter().zip(joints).zip(readings) {
            match reading {
                Ok(reading) => {
                    let steps = reading.value(PRESENT_POSITION);
                    let within = |steps: i32| {
                        steps.clamp(joint.calibration.range_min, joint.calibration.last_step())
                    };
                    goals.extend(steps.map(|steps| (*id, within(steps))));
                }
                Err(error) => failed = Some(error),
            }
        }
        self.send_goals(&goals, 0)?;
        failed.map_or(Ok(()), |error| Err(error.into()))
    }

    /// Switches the torque of every joint off at once. **The arm falls.** One request reaches all, three times as none is answered;
    /// then each servo is asked whether it did. The error names one that did not.
    pub fn release(&mut self) -> Result<(), ControllerError> {
        for _ in 0..3 {
            self.bus.broadcast(TORQUE_ENABLE, 0)?;
        }
        for joint in &mut self.joints {
            joint.torque = Torque::Off;
        }
        let ids = self.ids();
        let readings = self.bus.sync_read(&ids, TORQUE_ENABLE.into())?;
        let mut failed: Option<BusError> = None;
        for (id, reading) in ids.iter().zip(readings) {
            match reading {
                Ok(reading) if reading.value(TORQUE_ENABLE) == Some(0) => {}
                Ok(_) | Err(_) => {
                    failed = self.bus.write(*id, TORQUE_ENABLE, 0).err().or(failed);
                }
            }
        }
        failed.map_or(Ok(()), |error| Err(error.into()))
    }

    /// Whether torque of any joint is on, as far as is known.
    pub fn has_torque(&self) -> bool {
        self.joints.iter().any(|joint| joint.torque == Torque::On)
    }
}
