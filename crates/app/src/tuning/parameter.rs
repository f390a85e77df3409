//! A setting: its number, name and range.

use super::Refusal;
use crate::domain::RobotConfig;

/// Which numbers between its limits a setting may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// Any number.
    Float,
    /// Whole numbers.
    Integer,
    /// Only +1 and −1.
    Sign,
    /// The index of one of these names.
    Choice(&'static [&'static str]),
}

/// A setting of `RobotConfig`. All values are transferred as `f32`, which is exact for the integers in use.
#[derive(Debug)]
pub struct Parameter {
    /// Number within its group. It never changes.
    pub index: u8,
    /// Name within its group.
    pub name: &'static str,
    /// Unit, empty for a pure number.
    pub unit: &'static str,
    /// Smallest value.
    pub min: f32,
    /// Largest value.
    pub max: f32,
    /// Values allowed between the limits.
    pub kind: ParameterKind,
    pub(super) get: fn(&RobotConfig) -> f32,
    pub(super) set: fn(&mut RobotConfig, f32),
}

/// What the values of a group apply to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The whole robot.
    Robot,
    /// The joint at this index of the motor layout, with its present make of motor: zeros and limits do not apply to
    /// another make.
    Joint(usize),
}

/// Settings that belong together and are saved together (docs/parameters.md).
#[derive(Debug)]
pub struct ParameterGroup {
    /// Number of the group. It never changes.
    pub number: u8,
    /// Name of the group.
    pub name: &'static str,
    /// Version, increased by every firmware that appends settings to the group.
    pub version: u8,
    /// What the values apply to.
    pub scope: Scope,
    /// The settings in the order of their indices, which begin at 0 without gaps.
    pub parameters: &'static [Parameter],
}

impl ParameterGroup {
    /// Copies this group from one configuration to another. It is out of line, as flash is scarce.
    #[inline(never)]
    pub fn copy(&self, from: &RobotConfig, to: &mut RobotConfig) {
        for parameter in self.parameters {
            (parameter.set)(to, parameter.read(from));
        }
    }

    /// Whether all values of this group are equal, bit for bit.
    #[inline(never)]
    pub fn is_same(&self, one: &RobotConfig, other: &RobotConfig) -> bool {
        self.parameters
            .iter()
            .all(|parameter| parameter.read(one).to_bits() == parameter.read(other).to_bits())
    }
}

impl Parameter {
    /// Reads the setting.
    pub fn read(&self, config: &RobotConfig) -> f32 {
        (self.get)(config)
    }

    /// Writes the setting if `value` is allowed by itself; otherwise `config` stays unchanged.
    pub(crate) fn write(&self, config: &mut RobotConfig, value: f32) -> Result<(), Refusal> {
        if !value.is_finite() {
            return Err(Refusal::NotFinite);
        }
        let allowed = match self.kind {
            ParameterKind::Float => true,
            ParameterKind::Integer | ParameterKind::Choice(_) => (value as u32) as f32 == value,
            ParameterKind::Sign => value == 1.0 || value == -1.0,
        };
        if !allowed || !(self.min..=self.max).contains(&value) {
            return Err(Refusal::OutOfRange);
        }
        (self.set)(config, value);
        Ok(())
    }
}

/// `float!(index, "name", "unit", min, max, path in RobotConfig)`.
macro_rules! float {
    ($index:literal, $name:literal, $unit:literal, $min:expr, $max:expr, $($field:tt)+) => {
        Parameter {
            index: $index,
            name: $name,
            unit: $unit,
            min: $min,
            max: $max,
            kind: ParameterKind::Float,
            get: |config| config.$($field)+,
            set: |config, value| config.$($field)+ = value,
        }
    };
}

/// As `float!`, for a field of +1 or −1.
macro_rules! sign {
    ($index:literal, $name:literal, $($field:tt)+) => {
        Parameter {
            kind: ParameterKind::Sign,
            ..float!($index, $name, "", -1.0, 1.0, $($field)+)
        }
    };
}

/// As `float!`, for a `u32` field.
macro_rules! integer {
    ($index:literal, $name:literal, $unit:literal, $min:expr, $max:expr, $($field:tt)+) => {
        Parameter {
            index: $index,
            name: $name,
            unit: $unit,
            min: $min,
            max: $max,
            kind: ParameterKind::Integer,
            get: |config| config.$($field)+ as f32,
            set: |config, value| config.$($field)+ = value as u32,
        }
    };
}

pub(super) use {float, integer, sign};
