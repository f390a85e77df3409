//! Torque on and off.

use super::{ControllerError, ServoController};
use crate::bus::{
    BusError,
    register::{PRESENT_POSITION, TORQUE_ENABLE},
};

impl ServoController {
    /// Switches torque on without a jump: each joint's goal becomes the place where it is. Does nothing if it is on.
    pub fn enable_torque(&mut self) -> Result<(), ControllerError> {
        if self.has_torque {
            return Ok(());
        }
        self.hold()?;
        for id in self.ids() {
            self.bus.write(id, TORQUE_ENABLE, 1)?;
            // From the first servo on the arm has torque, so that its end takes care of it.
            self.has_torque = true;
        }
        Ok(())
    }

    /// Makes each joint's goal the place where it is: the arm stops and stays. A joint that does not answer keeps its goal, and is
    /// an error after all others have stopped.
    pub fn hold(&mut self) -> Result<(), ControllerError> {
        let ids = self.ids();
        let readings = self.bus.sync_read(&ids, PRESENT_POSITION.into())?;
        let mut goals = Vec::new();
        let mut failed = None;
        for ((id, joint), reading) in ids.iter().zip(&self.joints).zip(readings) {
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
        self.has_torque = false;
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

    pub fn has_torque(&self) -> bool {
        self.has_torque
    }
}
