//! Where the joints are.

use std::collections::BTreeMap;

use super::{ControllerError, ServoController, Warning, plausible::are_one, torque::Torque};
use crate::bus::{
    Alarms, Block, BlockReading, BusError, Cause, ServoError,
    register::{
        PRESENT_CURRENT, PRESENT_LOAD, PRESENT_POSITION, PRESENT_SPEED, PRESENT_TEMPERATURE,
        PRESENT_VOLTAGE, TORQUE_ENABLE,
    },
};

/// Positions of those joints that answered, in steps.
#[derive(Clone, Debug, Default)]
pub struct Positions {
    pub steps: BTreeMap<String, i32>,
    /// Joints without a position, and why.
    pub errors: Vec<ServoError>,
}

/// States of those joints that answered, in the order of their file.
#[derive(Clone, Debug, Default)]
pub struct States {
    pub joints: Vec<(String, JointState)>,
    pub errors: Vec<ServoError>,
}

/// What a servo says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointState {
    pub position_steps: i32,
    pub speed_steps_s: i32,
    /// In 0.1 % of the full drive.
    pub load_permille: i32,
    /// In 0.1 V.
    pub voltage_dv: i32,
    pub temperature_c: i32,
    /// In mA; the register counts 6.5 mA.
    pub current_ma: i32,
    pub alarms: Alarms,
}

impl ServoController {
    /// Reads all positions with one request. A joint that does not answer is an error beside the others' positions; only the loss
    /// of the port is an error of the call. Alarms become [warnings](Self::take_warnings).
    pub fn read_positions(&mut self) -> Result<Positions, ControllerError> {
        let ids = self.ids();
        let readings = self.bus.sync_read(&ids, PRESENT_POSITION.into())?;
        let mut positions = Positions::default();
        for (place, reading) in readings.into_iter().enumerate() {
            match reading {
                Ok(reading) => match self.position(place, &reading)? {
                    Ok((name, steps)) => drop(positions.steps.insert(name, steps)),
                    Err(error) => positions.errors.push(error),
                },
                Err(error) => {
                    self.note_missing(place);
                    positions.errors.push(error);
                }
            }
        }
        Ok(positions)
    }

    /// Reads the position of every joint. One that does not answer is an error: a loop uses [`read_positions`](Self::read_positions).
    pub fn read_servo_positions(&mut self) -> Result<BTreeMap<String, i32>, ControllerError> {
        let Positions { steps, errors } = self.read_positions()?;
        match errors.into_iter().next() {
            Some(error) => Err(error.into()),
            None => Ok(steps),
        }
    }

    /// Reads position, speed, load, voltage, temperature and current of all joints with one request.
    pub fn read_states(&mut self) -> Result<States, ControllerError> {
        let ids = self.ids();
        let block = Block::new(PRESENT_POSITION, PRESENT_CURRENT);
        let readings = self.bus.sync_read(&ids, block)?;
        let mut states = States::default();
        for (place, reading) in readings.into_iter().enumerate() {
            let reading = match reading {
                Ok(reading) => reading,
                Err(error) => {
                    self.note_missing(place);
                    states.errors.push(error);
                    continue;
                }
            };
            match self.position(place, &reading)? {
                Ok((name, steps)) => {
                    let state = joint_state(&reading, steps);
                    states.joints.extend(state.map(|state| (name, state)));
                }
                Err(error) => states.errors.push(error),
            }
        }
        Ok(states)
    }

    /// Takes a joint's position from an answer, after a second look if it is not plausible.
    fn position(
        &mut self,
        place: usize,
        reading: &BlockReading,
    ) -> Result<Result<(String, i32), ServoError>, ControllerError> {
        let Some(joint) = self.joints.get_mut(place) else {
            return Err(ControllerError::NoSteps);
        };
        let id = joint.calibration.id;
        let now = self.bus.now();
        let steps = reading.value(PRESENT_POSITION).unwrap_or_default();
        if !joint.plausible.is_plausible(now, steps) {
            match self.bus.read(id, PRESENT_POSITION) {
                Ok(again) if are_one(steps, again.value) => {}
                Ok(_) => {
                    return Ok(Err(ServoError {
                        id,
                        joint: Some(joint.name.clone()),
                        asked: "read present_position".to_owned(),
                        tries: 2,
                        cause: Cause::Damaged,
                    }));
                }
                Err(BusError::Servo(error)) => return Ok(Err(error)),
                Err(error) => return Err(error.into()),
            }
        }
        joint.plausible.take(now, steps);
        let name = joint.name.clone();
        if std::mem::take(&mut joint.is_missing) && joint.torque == Torque::On {
            self.look_for_torque(place)?;
        }
        self.note_alarms(&name, reading.alarms);
        Ok(Ok((name, steps)))
    }

    fn note_missing(&mut self, place: usize) {
        if let Some(joint) = self.joints.get_mut(place) {
            joint.is_missing = true;
        }
    }

    /// A servo that was without power has no torque. It gets none by itself, as somebody may have a hand at its plug.
    pub(super) fn look_for_torque(&mut self, place: usize) -> Result<(), ControllerError> {
        let Some(joint) = self.joints.get_mut(place) else {
            return Ok(());
        };
        match self.bus.read(joint.calibration.id, TORQUE_ENABLE) {
            Ok(torque) if torque.value == 0 => {
                joint.torque = Torque::Lost;
                let joint = joint.name.clone();
                self.warnings.push(Warning::NoTorque { joint });
            }
            Ok(_) => {}
            // It will be missing in the next reading.
            Err(BusError::Servo(_)) => joint.is_missing = true,
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }

    /// Makes a warning of alarms, unless the same one waits already.
    pub(super) fn note_alarms(&mut self, joint: &str, alarms: Alarms) {
        if alarms.is_none() {
            return;
        }
        let cures: Vec<&str> = alarms.cures().collect();
        let warning = Warning::Alarm {
            joint: joint.to_owned(),
            alarms: format!("{alarms}: {}", cures.join("; ")),
        };
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }
}

fn joint_state(reading: &BlockReading, position_steps: i32) -> Option<JointState> {
    Some(JointState {
        position_steps,
        speed_steps_s: reading.value(PRESENT_SPEED)?,
        load_permille: reading.value(PRESENT_LOAD)?,
        voltage_dv: reading.value(PRESENT_VOLTAGE)?,
        temperature_c: reading.value(PRESENT_TEMPERATURE)?,
        current_ma: reading.value(PRESENT_CURRENT)? * 13 / 2,
        alarms: reading.alarms,
    })
}
