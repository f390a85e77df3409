//! The Cortex-M4F. unicorn-engine executes the instructions; exceptions, NVIC, SCB, SysTick and DWT are implemented here.

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
