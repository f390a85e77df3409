//! A servo with its end of the wire.

use crate::{
    bus::line::{Ear, Party},
    frame::Scanner,
    servo::Servo,
};

/// A servo, what it hears with, and what faults do to it.
pub struct Unit {
    pub servo: Servo,
    pub ear: Ear,
    pub scanner: Scanner,
    /// When its UART has sent all it has.
    pub free_ns: u64,
    pub has_power: bool,
    /// Id that it writes into its answers, by a fault.
    pub wrong_id: Option<u8>,
    /// Its own id while a fault gives it another.
    pub own_id: Option<u8>,
    /// Supply without faults, V.
    pub rated_v: f64,
}

impl Unit {
    pub fn new(place: usize, servo: Servo) -> Self {
        Self {
            ear: Ear::new(Party::Servo(place)),
            scanner: Scanner::default(),
            free_ns: 0,
            has_power: true,
            wrong_id: None,
            own_id: None,
            rated_v: servo.supply_v(),
            servo,
        }
    }

    /// Takes the power away or gives it back.
    pub fn set_power(&mut self, has_power: bool, now_ns: u64) {
        if has_power && !self.has_power {
            self.servo.power_on();
            self.scanner.restart();
            self.ear.restart(now_ns);
        }
        self.has_power = has_power;
    }
}
