//! Cortex-M4F: instruction execution through unicorn-engine; exceptions, NVIC, SCB, SysTick and DWT here.

mod alignment;
pub mod clock;
pub mod cost;
pub mod cpu;
pub mod exception;
pub mod faults;
pub mod image;
pub mod memory;
pub mod nvic;
pub mod stats;
pub mod system;
pub mod systick;
