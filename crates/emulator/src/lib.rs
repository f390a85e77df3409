//! An emulated STM32F407: a firmware image boots here, unchanged.
//!
//! `core` runs the Cortex-M4F and its private peripherals, `soc` holds the chip's own peripherals. Whatever the pins
//! and buses lead to stands behind [`soc::board::Board`]; this crate knows no board.

#![deny(missing_docs)]

pub mod core;
pub mod soc;
pub mod time;
pub mod wire;
