//! Bosch BMI088 (BST-BMI088-DS000 rev 1.8): two dies on one SPI bus, each with its own
//! chip select. Mode 0 or 3, at most 10 MHz.

mod bring_up;
mod buffer_watch;
mod decode;
mod registers;
mod timing;

pub use bring_up::{INIT, InitCheck, InitStep, SpiTarget, read_command, write_command};
pub(super) use buffer_watch::BufferWatch;
pub use decode::{ACCEL_READ, BUFFER_READ, BUFFER_RESET, GYRO_READ, GyroBuffer, gyro_buffer};
pub(super) use decode::{AccelRaw, GyroRaw, decode_accel, decode_gyro};
pub(super) use timing::{SHARE_OF_LAST_ACCEL, measured_until_us};
