//! Bosch BMI088 (BST-BMI088-DS000 rev 1.8): accelerometer and gyro, two dies on one SPI bus.
//!
//! Each die has its own chip select. The bus runs in mode 0 or 3 at 10 MHz at most. A driver carries out [`INIT`], then
//! exchanges [`GYRO_READ`], the part of [`BUFFER_READ`] that [`gyro_buffer`] names, and [`ACCEL_READ`] every 5 ms:
//!
//! ```
//! use robot_app::sensing::bmi088::{self, GyroBuffer, InitStep};
//!
//! for step in bmi088::INIT {
//!     if let InitStep::Write { register, value, .. } = *step {
//!         let bytes = bmi088::write_command(register, value);
//!         assert_eq!(bytes[0] & 0x80, 0, "bit 7 is for reads");
//!     }
//! }
//!
//! // The last byte of an answer to GYRO_READ counts the frames in the buffer: five, 6 bytes each, behind the address.
//! let mut answer = [0; 16];
//! answer[15] = 5;
//! assert_eq!(bmi088::gyro_buffer(&answer), GyroBuffer::Frames { bytes: 31 });
//! ```

mod bring_up;
mod buffer_monitor;
mod decode;
mod registers;
mod timing;

pub use bring_up::{INIT, InitCheck, InitStep, SpiTarget, read_command, write_command};
pub(super) use buffer_monitor::BufferMonitor;
pub use decode::{ACCEL_READ, BUFFER_READ, BUFFER_RESET, GYRO_READ, GyroBuffer, gyro_buffer};
pub(super) use decode::{AccelRaw, GyroRaw, decode_accel, decode_gyro};
pub(super) use timing::{PREVIOUS_ACCEL_WEIGHT, interval_end_us};
