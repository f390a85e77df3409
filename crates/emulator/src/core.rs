//! Cortex-M4F: instruction execution through unicorn-engine; exceptions, NVIC, SCB, SysTick and DWT here.

mod alignment;
pub(crate) mod clock;
pub mod cost;
pub mod cpu;
pub(crate) mod exception;
pub(crate) mod faults;
pub mod image;
pub mod memory;
pub(crate) mod nvic;
pub mod stats;
pub mod system;
pub(crate) mod systick;
