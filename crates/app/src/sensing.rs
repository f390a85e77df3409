//! Sensor registers → calibrated samples, and how to bring the sensors up, as steps that a driver carries out.

mod accel_delay;
mod battery;
pub mod bmi088;
mod calibration;
mod gyro_series;
mod heater;
mod imu_pipeline;
mod imu_sample_error;
pub mod ist8310;
mod mag_pipeline;
mod mcu_temperature;
mod plausibility;

pub use battery::BatteryMonitor;
pub use imu_pipeline::ImuPipeline;
pub use imu_sample_error::ImuSampleError;
pub use mag_pipeline::{MagPipeline, MagSampleError};
pub use mcu_temperature::McuThermometer;
