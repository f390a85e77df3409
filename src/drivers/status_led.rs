//! The board's red-green-blue LED.

use embassy_stm32::gpio::Output;
use robot_app::indication::Colour;

/// The three outputs of the LED; high is on.
pub struct StatusLed {
    pub red: Output<'static>,
    pub green: Output<'static>,
    pub blue: Output<'static>,
}

impl StatusLed {
    /// Shows a colour.
    pub fn show(&mut self, colour: Colour) {
        let [red, green, blue] = colour.red_green_blue();
        self.red.set_level(red.into());
        self.green.set_level(green.into());
        self.blue.set_level(blue.into());
    }
}
