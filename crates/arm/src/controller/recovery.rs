//! Brings a servo back that protects itself.

use std::{fmt, time::Duration};

use super::{ControllerError, ServoController, torque::Torque};
use crate::bus::{
    Alarms, Block,
    register::{
        GOAL_POSITION, MAX_TEMPERATURE, MAX_VOLTAGE, MIN_VOLTAGE, PRESENT_POSITION,
        PRESENT_TEMPERATURE, PRESENT_VOLTAGE, STATUS, TORQUE_ENABLE,
    },
};

/// Time in which a servo notices that its torque is off, or that a cause is gone.
const SETTLE: Duration = Duration::from_millis(100);

/// What became of a servo.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// It had no alarm.
    Fine,
    /// It works again, with torque, and holds the place where it is.
    Recovered { had: Alarms },
    /// The voltage is out of the servo's range; in 0.1 V.
    Voltage {
        has_dv: i32,
        least_dv: i32,
        most_dv: i32,
    },
    /// It has to cool.
    Hot { has_c: i32, most_c: i32 },
    /// It still protects itself: the load is still there.
    StillThere { alarms: Alarms },
    /// Only a power cycle, or a new servo, helps.
    NeedsPowerCycle { alarms: Alarms },
}

impl fmt::Display for Recovery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let volts = |dv: &i32| f64::from(*dv) / 10.0;
        match self {
            Self::Fine => write!(f, "no alarm"),
            Self::Recovered { had } => write!(f, "works again, had: {had}"),
            Self::Voltage {
                has_dv,
                least_dv,
                most_dv,
            } => write!(
                f,
                "has {:.1} V, and takes {:.1} V to {:.1} V: a servo for 7.4 V on a supply of 12 V, or the reverse? Change \
                 the supply; the alarm goes by itself",
                volts(has_dv),
                volts(least_dv),
                volts(most_dv)
            ),
            Self::Hot { has_c, most_c } => write!(
                f,
                "has {has_c} °C, and stops at {most_c} °C: let it cool, without torque, and ask again"
            ),
            Self::StillThere { alarms } => write!(
                f,
                "still {alarms}: take the load away, or free what blocks the joint, and ask again"
            ),
            Self::NeedsPowerCycle { alarms } => write!(
                f,
                "still {alarms}, and no request ends that: switch the arm's power off and on; if it comes again, the servo's \
                 sensor is damaged"
            ),
        }
    }
}

impl ServoController {
    /// Brings a joint back after an overload, too much current, heat or a wrong voltage, where its servo allows that without a
    /// power cycle. An overload ends when torque is switched off and a goal without load follows: for a moment **the joint has no
    /// torque**. At the end it holds the place where it is.
    pub fn recover(&mut self, name: &str) -> Result<Recovery, ControllerError> {
        let id = self.joint(name)?.calibration.id;
        let had = self.alarms(id)?;
        if had.is_none() {
            return Ok(Recovery::Fine);
        }
        if let Some(outside) = self.what_is_out_of_range(id)? {
            return Ok(outside);
        }
        self.bus.write(id, TORQUE_ENABLE, 0)?;
        self.bus.wait(SETTLE)?;
        let steps = self.bus.read(id, PRESENT_POSITION)?.value;
        self.bus.write(id, GOAL_POSITION, steps)?;
        self.bus.write(id, TORQUE_ENABLE, 1)?;
        if let Some(joint) = self.joints.iter_mut().find(|joint| joint.name == name) {
            joint.torque = Torque::On;
        }
        self.bus.wait(SETTLE)?;
        let alarms = self.alarms(id)?;
        if alarms.is_none() {
            return Ok(Recovery::Recovered { had });
        }
        Ok(if alarms.contains(Alarms::ANGLE_SENSOR) {
            Recovery::NeedsPowerCycle { alarms }
        } else {
            Recovery::StillThere { alarms }
        })
    }

    fn alarms(&mut self, id: u8) -> Result<Alarms, ControllerError> {
        let reading = self.bus.read(id, STATUS)?;
        let status = u8::try_from(reading.value).ok().and_then(Alarms::from_byte);
        let byte = status.unwrap_or_default().byte() | reading.alarms.byte();
        Ok(Alarms::from_byte(byte).unwrap_or_default())
    }

    /// Heat and voltage: what no request can end.
    fn what_is_out_of_range(&mut self, id: u8) -> Result<Option<Recovery>, ControllerError> {
        let limits = self
            .bus
            .read_block(id, Block::new(MAX_TEMPERATURE, MIN_VOLTAGE))?;
        let now = self
            .bus
            .read_block(id, Block::new(PRESENT_VOLTAGE, PRESENT_TEMPERATURE))?;
        let limit = |register| limits.value(register).unwrap_or_default();
        let has_dv = now.value(PRESENT_VOLTAGE).unwrap_or_default();
        let has_c = now.value(PRESENT_TEMPERATURE).unwrap_or_default();
        let (least_dv, most_dv) = (limit(MIN_VOLTAGE), limit(MAX_VOLTAGE));
        let most_c = limit(MAX_TEMPERATURE);
        if !(least_dv..=most_dv).contains(&has_dv) {
            return Ok(Some(Recovery::Voltage {
                has_dv,
                least_dv,
                most_dv,
            }));
        }
        let is_hot = has_c >= most_c;
        Ok(is_hot.then_some(Recovery::Hot { has_c, most_c }))
    }
}
