//! Drivers: they move bytes by the tables of `robot_app` and know no formulas.

pub mod battery;
pub mod bmi088;
pub mod buzzer;
pub mod can;
pub mod cycle_jitter;
pub mod debug_probe;
pub mod heater;
pub mod ist8310;
pub mod param_flash;
pub mod radio_uart;
pub mod reset_cause;
pub mod status_led;
pub mod watchdog;
