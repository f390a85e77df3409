//! What the servo does against its own destruction.

use super::{
    memory::{
        MAX_TEMPERATURE, MAX_VOLTAGE, MIN_VOLTAGE, Memory, OVERCURRENT_TIME, OVERLOAD_TORQUE,
        PROTECTION_CURRENT, PROTECTION_TIME, PROTECTIVE_TORQUE, UNLOADING,
    },
    motor::CYCLE_S,
};

/// Bits of the error byte and of the status register.
pub mod status {
    /// The supply is outside of its limits.
    pub const VOLTAGE: u8 = 1 << 0;
    /// The case is too hot.
    pub const TEMPERATURE: u8 = 1 << 2;
    /// The current was too high for too long.
    pub const CURRENT: u8 = 1 << 3;
    /// The torque was too high for too long.
    pub const OVERLOAD: u8 = 1 << 5;
}

/// Current of one unit of the current registers, A.
pub const CURRENT_UNIT_A: f64 = 0.0065;
/// Seconds of one unit of the time registers.
const TIME_UNIT_S: f64 = 0.01;

/// What is measured in a cycle.
pub struct Measured {
    /// Torque as a part of the highest, 0 to 1.
    pub effort: f64,
    pub current_a: f64,
    pub supply_v: f64,
    pub temperature_c: f64,
}

/// Overload and overcurrent stay until [`reset`](Self::reset); voltage and temperature come and go with their cause.
#[derive(Clone, Debug, Default)]
pub struct Protection {
    status: u8,
    overload_s: f64,
    overcurrent_s: f64,
}

impl Protection {
    pub fn status(&self) -> u8 {
        self.status
    }

    /// Forgets overload and overcurrent.
    pub fn reset(&mut self) {
        self.status &= !(status::OVERLOAD | status::CURRENT);
        self.overload_s = 0.0;
        self.overcurrent_s = 0.0;
    }

    /// Whether the output is held down since the load was too high.
    pub fn is_overloaded(&self) -> bool {
        self.status & status::OVERLOAD != 0
    }

    /// The highest output that is left, 0 to 1. Only faults that the unloading register names take any away.
    pub fn output_limit(&self, memory: &Memory) -> f64 {
        let acting = self.status & memory.get(UNLOADING) as u8;
        if acting & !status::OVERLOAD != 0 {
            0.0
        } else if acting != 0 {
            f64::from(memory.get(PROTECTIVE_TORQUE)) / 100.0
        } else {
            1.0
        }
    }

    /// Takes what was measured in a cycle.
    pub fn step(&mut self, memory: &Memory, measured: &Measured) {
        let volts = |register| f64::from(memory.get(register)) / 10.0;
        let is_outside = !(volts(MIN_VOLTAGE)..=volts(MAX_VOLTAGE)).contains(&measured.supply_v);
        self.follow(status::VOLTAGE, is_outside);
        let is_hot = measured.temperature_c > f64::from(memory.get(MAX_TEMPERATURE));
        self.follow(status::TEMPERATURE, is_hot);

        let is_high = measured.effort * 100.0 > f64::from(memory.get(OVERLOAD_TORQUE));
        self.overload_s = count(self.overload_s, is_high);
        if self.overload_s > f64::from(memory.get(PROTECTION_TIME)) * TIME_UNIT_S {
            self.status |= status::OVERLOAD;
        }
        let limit_a = f64::from(memory.get(PROTECTION_CURRENT)) * CURRENT_UNIT_A;
        self.overcurrent_s = count(self.overcurrent_s, measured.current_a > limit_a);
        if self.overcurrent_s > f64::from(memory.get(OVERCURRENT_TIME)) * TIME_UNIT_S {
            self.status |= status::CURRENT;
        }
    }

    fn follow(&mut self, bit: u8, is_set: bool) {
        self.status = if is_set {
            self.status | bit
        } else {
            self.status & !bit
        };
    }
}

fn count(so_far_s: f64, goes_on: bool) -> f64 {
    if goes_on { so_far_s + CYCLE_S } else { 0.0 }
}
