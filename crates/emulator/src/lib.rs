//! An emulated STM32F407, on which an unchanged firmware image boots.
//!
//! `core` runs the Cortex-M4F and its private peripherals, `soc` holds the chip's own peripherals. The devices
//! at pins and buses are behind [`soc::board::Board`]; this crate contains no board.

#![deny(missing_docs)]

pub mod core;
pub mod soc;
pub mod wire;

pub use robot_wire::time;
