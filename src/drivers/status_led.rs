//! The board's red-green-blue LED.

use embassy_stm32::gpio::Output;

/// What the LED shows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    Off,
    Red,
    Green,
    Blue,
}

/// Three outputs, high = on.
pub struct StatusLed {
    pub red: Output<'static>,
    pub green: Output<'static>,
    pub blue: Output<'static>,
}

impl StatusLed {
    pub fn show(&mut self, colour: Colour) {
        self.red.set_level((colour == Colour::Red).into());
        self.green.set_level((colour == Colour::Green).into());
        self.blue.set_level((colour == Colour::Blue).into());
    }
}
