//! Sensor registers → calibrated samples; how to bring the sensors up, as data that a driver walks.

mod accel_delay;
mod battery;
pub mod bmi088;
mod calibration;
mod gyro_series;
mod heater;
mod imu_pipeline;
pub mod ist8310;
mod mag_pipeline;
mod plausibility;

pub use battery::BatteryMonitor;
pub use imu_pipeline::{ImuPipeline, ImuSampleError};
pub use mag_pipeline::{MagPipeline, MagSampleError};
