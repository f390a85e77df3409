//! One setting: its number, its name, what it may be.

use super::Refusal;
use crate::domain::RobotConfig;

/// Which of the numbers between its limits a setting may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    Float,
    Integer,
    /// Only +1 and −1.
    Sign,
    /// The place of one of these names.
    Choice(&'static [&'static str]),
}

/// A setting of `RobotConfig`. All travel as `f32`, which is exact for the integers here.
#[derive(Debug)]
pub struct Parameter {
    /// Inside its group; never changes.
    pub index: u8,
    /// Inside its group.
    pub name: &'static str,
    /// Empty for a pure number.
    pub unit: &'static str,
    pub min: f32,
    pub max: f32,
    pub kind: ParameterKind,
    pub(super) get: fn(&RobotConfig) -> f32,
    pub(super) set: fn(&mut RobotConfig, f32),
}

/// What the values of a group are true for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    Robot,
    /// The joint with this position in the motor layout, with the make of motor it has now: zeros and limits of another
    /// make would be wrong.
    Joint(usize),
}

/// Settings that belong together. They are saved together (docs/parameters.md).
#[derive(Debug)]
pub struct ParameterGroup {
    /// Never changes.
    pub number: u8,
    pub name: &'static str,
    /// Grows by one with every firmware that appends settings to the group.
    pub version: u8,
    pub scope: Scope,
    /// In the order of their indices, which begin at 0 and leave none out.
    pub parameters: &'static [Parameter],
}

impl ParameterGroup {
    /// Makes this group in `to` what it is in `from`. Out of line, as more here: flash is scarce.
    #[inline(never)]
    pub fn copy(&self, from: &RobotConfig, to: &mut RobotConfig) {
        for parameter in self.parameters {
            (parameter.set)(to, parameter.read(from));
        }
    }

    /// True if each value is the same, bit for bit.
    #[inline(never)]
    pub fn is_same(&self, one: &RobotConfig, other: &RobotConfig) -> bool {
        self.parameters
            .iter()
            .all(|parameter| parameter.read(one).to_bits() == parameter.read(other).to_bits())
    }
}

impl Parameter {
    pub fn read(&self, config: &RobotConfig) -> f32 {
        (self.get)(config)
    }

    /// Unchanged unless `value` is one this setting may take by itself.
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
