//! Whether the servos are those of the calibration.

use super::{ControllerError, Mismatch, ServoController, Warning};
use crate::{
    bus::{
        Block,
        register::{
            FIRMWARE_MAJOR, FIRMWARE_MINOR, HOMING_OFFSET, MAX_POSITION, MIN_POSITION, MODE, MODEL,
            RETURN_DELAY,
        },
    },
    calibration::STEPS_PER_TURN,
};

/// The model number of an STS3215.
const STS3215: i32 = 777;

impl ServoController {
    /// Asks every servo for what a calibration depends on, and learns its return delay. What differs is a warning, except that the
    /// arm is not as wanted: then the joints would go elsewhere.
    pub(super) fn check_servos(&mut self) -> Result<(), ControllerError> {
        let ids = self.ids();
        let fixed = self
            .bus
            .sync_read(&ids, Block::new(FIRMWARE_MAJOR, MODEL))?;
        let stored = self.bus.sync_read(&ids, Block::new(RETURN_DELAY, MODE))?;
        let mut versions = Vec::new();
        let mut found = Vec::new();
        for ((joint, fixed), stored) in self.joints.iter().zip(fixed).zip(stored) {
            let (fixed, stored) = (fixed?, stored?);
            let value = |register| stored.value(register).unwrap_or_default();
            let name = || joint.name.clone();
            let (wanted, has) = (
                self.calibration.servo_offset(&joint.calibration),
                value(HOMING_OFFSET),
            );
            if wanted != has {
                let joint = name();
                found.push(Mismatch::Offset { joint, wanted, has });
            }
            if value(MODE) != 0 {
                let (joint, has) = (name(), value(MODE));
                found.push(Mismatch::Mode { joint, has });
            }
            let model = fixed.value(MODEL).unwrap_or_default();
            if model != STS3215 {
                let (joint, has) = (name(), model);
                found.push(Mismatch::Model { joint, has });
            }
            let part = |register| fixed.value(register).unwrap_or_default();
            let version = format!("{}.{}", part(FIRMWARE_MAJOR), part(FIRMWARE_MINOR));
            if !versions.contains(&version) {
                versions.push(version);
            }
        }
        if versions.len() > 1 {
            let versions = versions.join(", ");
            found.push(Mismatch::Firmware { versions });
        }
        self.warnings
            .extend(found.into_iter().map(Warning::Mismatch));
        Ok(())
    }

    /// Stores the calibration in the servos: offset, limits, position mode, and no return delay. Switches their torque off: **the
    /// arm falls.** A servo without a travel of its own gets the limits of a whole turn.
    pub fn apply_calibration(&mut self) -> Result<(), ControllerError> {
        self.release()?;
        for place in 0..self.joints.len() {
            let Some(joint) = self.joints.get(place) else {
                break;
            };
            let calibration = joint.calibration;
            let values = [
                (RETURN_DELAY, 0),
                (MIN_POSITION, calibration.range_min),
                (MAX_POSITION, calibration.range_max.min(STEPS_PER_TURN - 1)),
                (HOMING_OFFSET, self.calibration.servo_offset(&calibration)),
                (MODE, 0),
            ];
            self.bus.store(calibration.id, &values)?;
        }
        Ok(())
    }
}
