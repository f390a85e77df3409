//! Drivers. They move bytes according to the tables of `robot_app`, which has the formulas.

pub mod analog;
pub mod bmi088;
pub mod buzzer;
pub mod can;
pub mod cycle_jitter;
pub mod debug_probe;
pub mod heater;
pub mod ist8310;
pub mod param_flash;
pub mod reset_cause;
pub mod status_led;
pub mod uart;
pub mod watchdog;
