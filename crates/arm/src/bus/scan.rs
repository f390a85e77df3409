//! Finds servos.

use super::{
    Alarms, Block, BusError, Cause, Retries, ServoBus,
    register::{
        FIRMWARE_MAJOR, FIRMWARE_MINOR, MODEL, PRESENT_POSITION, PRESENT_TEMPERATURE,
        PRESENT_VOLTAGE,
    },
};

/// Speeds of servos in bits per second, that of a new one first. Sources disagree on the slower ones.
pub const BAUD_RATES: [u32; 9] = [
    1_000_000, 500_000, 250_000, 128_000, 115_200, 76_800, 57_600, 38_400, 19_200,
];

/// Whether a servo answers to an id.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    Absent,
    Present,
    /// Something answers, but damaged: two servos have this id, or the speed is another one.
    Damaged,
}

/// What a servo is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Identity {
    pub id: u8,
    /// 777 is an STS3215.
    pub model: i32,
    pub firmware_major: i32,
    pub firmware_minor: i32,
    pub position: i32,
    /// In 0.1 V.
    pub voltage_dv: i32,
    pub temperature_c: i32,
    #[serde(skip)]
    pub alarms: Alarms,
}

impl ServoBus {
    /// Asks twice whether a servo has this id.
    pub fn presence(&mut self, id: u8) -> Result<Presence, BusError> {
        let retries = self.retries;
        self.silent.remove(&id);
        self.set_retries(Retries {
            tries: 2,
            ..retries
        });
        let pinged = self.ping(id);
        self.set_retries(retries);
        // An id that nobody has owes no answer.
        self.silent.remove(&id);
        match pinged {
            Ok(_) => Ok(Presence::Present),
            Err(BusError::Servo(error)) if error.cause == Cause::Damaged => Ok(Presence::Damaged),
            Err(BusError::Servo(_)) => {
                self.unsettled.remove(&id);
                Ok(Presence::Absent)
            }
            Err(error) => Err(error),
        }
    }

    /// Asks a servo what it is.
    pub fn identify(&mut self, id: u8) -> Result<Identity, BusError> {
        let fixed = self.read_block(id, Block::new(FIRMWARE_MAJOR, MODEL))?;
        let now = self.read_block(id, Block::new(PRESENT_POSITION, PRESENT_TEMPERATURE))?;
        let all = || {
            Some(Identity {
                id,
                model: fixed.value(MODEL)?,
                firmware_major: fixed.value(FIRMWARE_MAJOR)?,
                firmware_minor: fixed.value(FIRMWARE_MINOR)?,
                position: now.value(PRESENT_POSITION)?,
                voltage_dv: now.value(PRESENT_VOLTAGE)?,
                temperature_c: now.value(PRESENT_TEMPERATURE)?,
                alarms: now.alarms,
            })
        };
        Ok(all().ok_or_else(|| self.servo_error(id, "identify", 1, Cause::Damaged))?)
    }
}
